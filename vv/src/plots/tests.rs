//! Behaviour of whole figures.

use super::*;

fn panel() -> Panel {
    Panel::new("Errors", Axis::log("n"), Axis::log("‖e‖"))
        .with(
            Series::marked("a", vec![(10.0, 1.0), (100.0, 0.1)])
                .errors(vec![(0.2, 0.2), (1.0, 0.1)]),
        )
        .with(Layer::slope(-1.0))
        .with(Layer::horizontal(0.5, "bound"))
}

fn figure(panel: Panel) -> Figure {
    Figure::new("f", "a < b", vec![panel])
}

/// Every number in a drawing, to see that none got lost in infinity.
fn sound(svg: &str) -> bool {
    !svg.contains("NaN") && !svg.contains("inf") && !svg.contains(&i32::MAX.to_string())
}

#[test]
fn drawings_are_the_same_every_time() {
    let svg = render_svg(&figure(panel())).unwrap();
    assert_eq!(svg, render_svg(&figure(panel())).unwrap());
    assert!(svg.starts_with("<svg ") && svg.contains("aria-label=\"a &lt; b\""));
    assert_eq!(svg_to_png(&svg, 1.0).unwrap(), svg_to_png(&svg, 1.0).unwrap());
}

#[test]
fn pictures_decode_and_stay_small() {
    let svg = render_svg(&figure(panel())).unwrap();
    let png = svg_to_png(&svg, 2.0).unwrap();
    let picture = resvg::tiny_skia::Pixmap::decode_png(&png).unwrap();
    assert_eq!((picture.width(), picture.height()), (1360, 840));
    assert!(picture.pixels().iter().any(|p| (p.red(), p.green(), p.blue()) == (0x00, 0x72, 0xB2)));
    assert!(png.len() < 300_000);
}

#[test]
fn any_data_can_be_drawn() {
    let bad = [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e-320, 1e300, f64::MAX, f64::MIN];
    let points: Vec<Point> = bad.iter().flat_map(|x| bad.map(|y| (*x, y))).collect();
    for (x, y) in [(Axis::linear("x"), Axis::linear("y")), (Axis::log("x"), Axis::log("y"))] {
        for data in
            [vec![], vec![(1.0, 1.0)], points.clone(), vec![(1e-140, 1e140), (1e140, 1e-140)]]
        {
            let edges = data.iter().map(|(x, y)| (*x, *y, 2.0 * y)).collect();
            let panel = Panel::new("", x.clone(), y.clone())
                .with(Series::marked("s", data.clone()).errors(vec![(f64::NAN, 1e9); data.len()]))
                .with(Series::line("t", data.clone()))
                .with(Layer::exact("e", data))
                .with(Layer::Band { name: "b".into(), edges })
                .with(Layer::vertical(f64::NAN, "nowhere"))
                .with(Layer::horizontal(-3.0, "below"))
                .with(Layer::Note { at: (0.0, f64::NAN), text: "x".into() });
            assert!(sound(&render_svg(&figure(panel)).unwrap()));
        }
    }
    let far = Panel::new("", Axis::linear("x").range(0.0, 1.0), Axis::linear("y").range(0.0, 1.0))
        .with(Series::line("s", vec![(-1e100, -1e100), (1e100, 1e100)]));
    assert!(sound(&render_svg(&figure(far)).unwrap()));
}

#[test]
fn skipped_points_are_told() {
    let panel = Panel::new("", Axis::linear("x"), Axis::log("y"))
        .with(Series::scatter("s", vec![(0.0, 1.0), (1.0, 0.0), (2.0, -1.0)]));
    assert!(render_svg(&figure(panel)).unwrap().contains("2 not drawable"));
    let empty = Panel::new("", Axis::linear("x"), Axis::log("y"));
    assert!(render_svg(&figure(empty)).unwrap().contains("no data"));
}

#[test]
fn many_points_make_small_files() {
    let wave = |k: i32| {
        (0..1000).map(|i| (f64::from(i), (f64::from(i) / 50.0).sin() + f64::from(k))).collect()
    };
    let full = (0..8).fold(Panel::new("", Axis::linear("x"), Axis::linear("y")), |panel, k| {
        panel.with(Series::scatter(k.to_string(), wave(k)))
    });
    assert!(render_svg(&figure(full)).unwrap().len() < 500_000);
}

#[test]
fn contradictions_are_errors() {
    let error = |panel: Panel| render_svg(&figure(panel)).unwrap_err();
    let linear = || Panel::new("", Axis::linear("x"), Axis::linear("y"));
    assert!(matches!(render_svg(&Figure::new("f", "", vec![])), Err(PlotError::Panels(0))));
    assert!(matches!(error(linear().with(Layer::slope(1.0))), PlotError::Slope(_)));
    let limits = Panel::new("", Axis::log("x").range(-1.0, 1.0), Axis::linear("y"));
    assert!(matches!(error(limits), PlotError::Range(_)));
    let bars = linear().with(Series::line("s", vec![(0.0, 0.0)]).errors(vec![(1.0, 1.0); 2]));
    assert!(matches!(error(bars), PlotError::ErrorBars { points: 1, errors: 2, .. }));
    let nine = (0..9).fold(linear(), |p, k| p.with(Series::line(k.to_string(), vec![])));
    assert!(matches!(error(nine), PlotError::TooManySeries(9)));
    assert!(matches!(svg_to_png("no svg", 1.0), Err(PlotError::Svg(_))));
    let svg = render_svg(&figure(linear())).unwrap();
    assert!(matches!(svg_to_png(&svg, 1e9), Err(PlotError::PictureSize { .. })));
    assert!(matches!(svg_to_png(&svg, f32::NAN), Err(PlotError::PictureSize { .. })));
}

#[test]
fn equal_scales_make_squares_of_squares() {
    let square = vec![(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (0.0, 0.0)];
    let panel = Panel::new("", Axis::linear("x"), Axis::linear("y"));
    let panel = panel.with(Series::line("s", square.clone())).equal();
    let figure = figure(panel);
    let layout = layout::Layout::new(&figure).unwrap();
    let corners: Vec<Point> =
        guides::pixels(&square, layout.plots[0].map).into_iter().flatten().collect();
    let (across, up) = (corners[1].0 - corners[0].0, corners[1].1 - corners[2].1);
    assert!(across > 100.0 && (across - up).abs() < 1e-6, "{across} {up}");
}

#[test]
fn a_series_may_have_the_colour_of_another() {
    let line = |name: &str| Series::line(name, vec![(0.0, 0.0), (1.0, 1.0)]);
    let panel =
        |b: Series| Panel::new("", Axis::linear("x"), Axis::linear("y")).with(line("a")).with(b);
    let second = format!("#{:06X}", THEME[7].1);
    assert!(render_svg(&figure(panel(line("b")))).unwrap().contains(&second));
    let alike = panel(line("b").styled(Dash::Dashed, 0));
    assert!(!render_svg(&figure(alike)).unwrap().contains(&second));
}
