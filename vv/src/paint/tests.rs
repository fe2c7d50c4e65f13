//! Whole pictures: their geometry in pixels, their bytes and their errors.

use super::*;

const MARK: Mark = Mark { value: 1.0, class: 0 };

fn sphere(centre: Vec3, radius: f64) -> Sphere {
    Sphere { centre, radius, mark: MARK }
}

/// A box of one element.
fn block(low: Vec3, high: Vec3) -> Model {
    let pick = |c: [usize; 3]| [0, 1, 2].map(|i| if c[i] == 0 { low[i] } else { high[i] });
    let corners =
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let hexahedra = vec![Hexahedron { nodes: [0, 1, 2, 3, 4, 5, 6, 7], mark: MARK }];
    Model { points: corners.map(pick).to_vec(), hexahedra, ..Model::default() }
}

fn balls(spheres: Vec<Sphere>) -> Model {
    Model { spheres, ..Model::default() }
}

fn plain(direction: Vec3, up: Vec3) -> Picture {
    let camera = Camera::new(direction, up);
    let colouring = Colouring::Classes(vec!["body".into()]);
    Picture { edges: false, width: 400, ..Picture::new(camera, colouring) }
}

fn front() -> Picture {
    plain([0.0, 0.0, 1.0], [0.0, -1.0, 0.0])
}

/// Samples of a scene at a scale of 100 samples per length, and the facets that were drawn.
fn samples(model: &Model, picture: &Picture) -> (Buffer, usize) {
    let axes = picture.camera.axes().unwrap();
    let cut = picture.section.as_ref().map(|p| Cut::new(p, &axes).unwrap());
    let facets = surface::facets(model, cut.as_ref());
    let mut extent = Extent::NONE;
    extent.add([0.0; 3], [4.0; 3]);
    let view = View::fit(axes, &extent, (800, 800), 0.0).unwrap();
    let style = Style { tone: 0, class: 0 };
    let triangles: Vec<Triangle> =
        facets.iter().map(|f| Triangle::new(f, &view, 2.0, style)).collect();
    let particles: Vec<Particle> =
        model.particles().map(|(c, a, _)| Particle::new(c, &a, &view, 1.0, style)).collect();
    let plane = cut.map(|c| c.depth(&view));
    (Buffer::draw((800, 800), &triangles, &particles, plane.as_ref()), facets.len())
}

fn area(buffer: &Buffer, wanted: impl Fn(&raster::Sample) -> bool) -> f64 {
    buffer.samples.iter().filter(|s| wanted(s)).count() as f64 * 1e-4
}

fn covered(sample: &raster::Sample) -> bool {
    sample.depth < f32::INFINITY
}

#[test]
fn the_same_picture_has_the_same_bytes_on_any_number_of_threads() {
    let spheres = (0..400)
        .map(|i| {
            let t = f64::from(i);
            sphere([t.sin() * 3.0, (1.7 * t).cos() * 2.0, (0.3 * t).sin()], 0.2 + 0.1 * t.cos())
        })
        .collect();
    let model = Model { spheres, ..block([-1.0, -1.0, -0.3], [2.0, 0.5, 0.4]) };
    let section = Some(Plane { point: [0.0; 3], normal: [0.2, 0.1, 1.0] });
    let picture = Picture { width: 500, section, ..plain([0.3, 0.5, 1.0], [0.0, -1.0, 0.0]) };
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| paint(&model, &picture)).unwrap()
    };
    let once = on(1);
    assert!(once == on(1) && once == on(2) && once == on(5));
}

#[test]
fn the_cap_of_a_cut_cube_is_the_exact_polygon() {
    let cube = block([-1.0; 3], [1.0; 3]);
    // Seen along the diagonal, the cut through the centre is a regular hexagon of side √2.
    // The turn of the picture keeps its edges off the rows and columns of samples.
    let mut picture = plain([-1.0; 3], [0.3, 0.1, 1.0]);
    picture.section = Some(Plane { point: [0.0; 3], normal: [1.0; 3] });
    let hexagon = area(&samples(&cube, &picture).0, |s| s.cap);
    assert!((hexagon / 27.0_f64.sqrt() - 1.0).abs() < 2e-3, "{hexagon}");
    // Nearer to a corner it is a triangle of the same side.
    picture.section = Some(Plane { point: [1.0, 1.0, 0.0], normal: [-1.0; 3] });
    let triangle = area(&samples(&cube, &picture).0, |s| s.cap);
    assert!((triangle / (0.25 * 3.0_f64.sqrt() * 2.0) - 1.0).abs() < 5e-3, "{triangle}");
}

#[test]
fn a_section_along_faces_shows_them_as_caps() {
    let mut picture = front();
    picture.section = Some(Plane { point: [0.0, 0.0, -1.0], normal: [0.0, 0.0, 1.0] });
    let (buffer, _) = samples(&block([-1.0; 3], [1.0; 3]), &picture);
    assert!((area(&buffer, |s| s.cap) - 4.0).abs() < 0.01);
    assert!((area(&buffer, |s| s.cap) - area(&buffer, covered)).abs() < 1e-9);
}

#[test]
fn particles_have_their_silhouette_and_cap() {
    use std::f64::consts::PI;
    let ball = balls(vec![sphere([0.3, -0.2, 5.0], 2.0)]);
    let disc = area(&samples(&ball, &front()).0, covered);
    assert!((disc / (4.0 * PI) - 1.0).abs() < 2e-3, "{disc}");
    let mut cut = front();
    cut.section = Some(Plane { point: [0.0, 0.0, 6.0], normal: [0.0, 0.0, 1.0] });
    let cap = area(&samples(&ball, &cut).0, |s| s.cap);
    assert!((cap / (3.0 * PI) - 1.0).abs() < 2e-3, "{cap}");
    let (s, c) = 0.5_f64.sin_cos();
    let directions = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]];
    let ellipsoid =
        Ellipsoid { centre: [0.0; 3], half_axes: [2.0, 0.5, 1.0], directions, mark: MARK };
    let model = Model { ellipsoids: vec![ellipsoid], ..Model::default() };
    let ellipse = area(&samples(&model, &front()).0, covered);
    assert!((ellipse / PI - 1.0).abs() < 5e-3, "{ellipse}");
}

#[test]
fn cold_bodies_have_a_rim_on_dark_paper() {
    let (buffer, _) = samples(&block([-1.0; 3], [1.0; 3]), &front());
    let cold = ColourMap::Heat.at(0.0);
    let pixels = |theme: Theme| {
        let look = Look {
            tones: &[cold],
            paper: theme.paper(),
            rim: theme.rim(),
            lamp: (1.0, 1.0),
            occlusion: 0.0,
            scale: 1.0,
            calm: resolve::Calm { plain: 3.0, floor: 0.25 },
        };
        resolve(&buffer, &look)
    };
    let contrast = |a, b| {
        let [a, b] = [a, b].map(|c| colour::luminance(c) + 0.05);
        if a > b { a / b } else { b / a }
    };
    let paper = Theme::Dark.paper();
    assert!(contrast(cold, paper) < 1.5);
    // A square of 100 pixels with a rim one pixel wide; 3 is what WCAG 2.2 (1.4.11) asks of shapes.
    let dark = pixels(Theme::Dark);
    let rim = dark.iter().filter(|p| contrast(**p, paper) >= 3.0).count();
    assert!((390..=400).contains(&rim), "{rim}");
    // On light paper the rim is darker than the body.
    let light = pixels(Theme::Light);
    let body = colour::luminance(cold);
    assert_eq!(light.iter().filter(|p| colour::luminance(**p) < 0.9 * body).count(), rim);
}

#[test]
fn only_outer_faces_are_drawn() {
    let mut pair = block([-1.0; 3], [0.0, 1.0, 1.0]);
    pair.points.extend([[1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0]]);
    pair.hexahedra.push(Hexahedron { nodes: [1, 8, 9, 2, 5, 10, 11, 6], mark: MARK });
    let (buffer, facets) = samples(&pair, &front());
    assert_eq!(facets, 20);
    assert!((area(&buffer, covered) - 4.0).abs() < 0.01);
}

#[test]
fn framing_shows_everything_or_the_given_box() {
    let axes = front().camera.axes().unwrap();
    let mut extent = Extent::NONE;
    extent.add(axes.turn([3.0, 4.0, 5.0]), [2.0, 1.0, 7.0]);
    let view = View::fit(axes, &extent, (400, 200), 0.0).unwrap();
    assert!((view.scale - 100.0).abs() < 1e-9);
    let [x, y, z] = view.project([5.0, 3.0, 5.0]);
    assert!((x - 400.0).abs() < 1e-3 && y.abs() < 1e-3 && z.abs() < 1e-3, "{x} {y} {z}");

    let mut picture = front();
    picture.camera.frame = Some([[0.0; 3], [2.0, 1.0, 9.0]]);
    let shown = super::extent(&picture, &axes, &[], &[([0.0; 3], [[9.0; 3]; 3], MARK)]).unwrap();
    assert_eq!(shown.size(), (2.0, 1.0));
}

#[test]
fn a_crowd_fits_into_the_limit() {
    // Particles of 7 pixels, two and a half deep: noise, which is what makes files large.
    let spheres = (0..3_200_u32)
        .map(|i| {
            let part = |k: u32| f64::from(i.wrapping_mul(k) >> 8) / f64::from(1_u32 << 24);
            let p = [part(2_654_435_761), part(2_246_822_519), part(3_266_489_917)];
            Sphere { centre: p, radius: 0.018, mark: Mark { value: p[2] as f32, class: 0 } }
        })
        .collect();
    let model = balls(spheres);
    let field = Field { name: "z".into(), unit: "m".into(), range: None, map: ColourMap::Viridis };
    let mut picture = Picture { colouring: Colouring::Field(field), ..front() };
    let whole = paint(&model, &picture).unwrap().len();
    for part in [2, 3] {
        picture.max_bytes = whole / part;
        let length = paint(&model, &picture).unwrap().len();
        // The limit is met, and not by giving everything away.
        assert!((whole / (3 * part)..=whole / part).contains(&length), "{length} of {whole}");
    }
}

#[test]
fn texts_may_be_anything() {
    let picture = Picture {
        title: format!("a < b & \"c\" \u{1}{}", "long ".repeat(60)),
        time: "t = 1 µs".into(),
        length: Length { unit: "µm".into(), factor: 1e4 },
        ..front()
    };
    assert!(paint(&balls(vec![sphere([0.0; 3], 1.0)]), &picture).is_ok());
}

#[test]
fn contradictions_are_errors() {
    let ball = balls(vec![sphere([0.0; 3], 1.0)]);
    let error = |model: &Model, change: &dyn Fn(&mut Picture)| {
        let mut picture = front();
        change(&mut picture);
        paint(model, &picture).unwrap_err()
    };
    let same = |_: &mut Picture| ();
    assert!(matches!(error(&Model::default(), &same), PaintError::EmptyModel));
    for wrong in [sphere([f64::NAN, 0.0, 0.0], 1.0), sphere([0.0; 3], -1.0)] {
        assert!(matches!(error(&balls(vec![wrong]), &same), PaintError::Primitive { .. }));
    }
    let mut lost = block([0.0; 3], [1.0; 3]);
    lost.hexahedra[0].nodes[3] = 8;
    assert!(matches!(error(&lost, &same), PaintError::Primitive { index: 0, .. }));
    let point = block([1.0; 3], [1.0; 3]);
    assert!(matches!(error(&point, &same), PaintError::NothingVisible));
    for size in [(0, None), (1400, Some(0)), (1 << 20, None), (8000, Some(201))] {
        let refused = error(&ball, &|p| (p.width, p.height) = size);
        assert!(matches!(refused, PaintError::Size { .. }), "{refused}");
    }
    let up = |p: &mut Picture| p.camera.up = p.camera.direction;
    assert!(matches!(error(&ball, &up), PaintError::Camera));
    let cut = |point, normal| move |p: &mut Picture| p.section = Some(Plane { point, normal });
    assert!(matches!(error(&ball, &cut([0.0; 3], [0.0; 3])), PaintError::Section));
    assert!(matches!(error(&ball, &cut([0.0; 3], [1.0, 0.0, 0.0])), PaintError::Section));
    let beyond = cut([0.0, 0.0, 3.0], [0.0, 0.0, 1.0]);
    assert!(matches!(error(&ball, &beyond), PaintError::NothingVisible));
    let unnamed = |p: &mut Picture| p.colouring = Colouring::Classes(Vec::new());
    assert!(matches!(error(&ball, &unnamed), PaintError::Class(0)));
    let tiny = |p: &mut Picture| p.max_bytes = 100;
    assert!(matches!(error(&ball, &tiny), PaintError::TooLarge { limit: 100, .. }));
}
