//! Pictures of a run in three dimensions: its elements, and the particles that no element holds.

use whipple_solver::space::output::{Element, Particle};
use whipple_solver::space::{Scene, Simulation};
use whipple_solver::units::{Dimension, Units};

use super::frames::places;
use crate::paint::{
    Camera, ColourMap, Colouring, Ellipsoid, Field, Hexahedron, Length, Mark, Model, PaintError,
    Picture, Plane, Sphere, Theme, paint,
};

/// What decides the colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shown {
    /// The body.
    Body,
    /// The temperature, between two values at the ends of the colour bar or those of the state.
    Temperature(Option<(f64, f64)>),
    /// The effective plastic strain of elements, likewise; loose particles have none.
    PlasticStrain(Option<(f64, f64)>),
    /// The material.
    Material,
    /// The size of the velocity.
    Velocity,
    /// The pressure.
    Pressure,
    /// The density.
    Density,
    /// The damage of elements, from 0 to 1; loose particles have none.
    Damage,
}

impl Shown {
    /// Its value at a particle; what only elements have is not a number.
    fn of(self, p: &Particle) -> f64 {
        match self {
            Self::Body | Self::Material | Self::Temperature(_) => p.theta,
            Self::Velocity => p.velocity.iter().map(|v| v * v).sum::<f64>().sqrt(),
            Self::Pressure => p.pressure,
            Self::Density => p.rho,
            Self::PlasticStrain(_) | Self::Damage => f64::NAN,
        }
    }
}

/// A picture of a state.
#[derive(Debug, Clone, PartialEq)]
pub struct Shot {
    /// Heading.
    pub title: String,
    /// From where to look.
    pub camera: Camera,
    /// Where to cut.
    pub section: Option<Plane>,
    /// How to colour.
    pub shown: Shown,
    /// Whether particles that no element holds are painted.
    pub loose: bool,
}

/// Looks at a body that comes along x and y, and at the plate across y that it meets, from above and
/// the side: both faces of what comes and the front of the plate are seen.
#[must_use]
pub fn from_the_side() -> Camera {
    Camera::new([0.28, 0.42, -1.0], [-0.1, 1.0, 0.3])
}

/// Looks straight at a plane of section across z.
#[must_use]
pub fn onto_the_section() -> Camera {
    Camera::new([0.0, 0.0, -1.0], [0.0, 1.0, 0.0])
}

/// The plane z = 0, in which the problem is symmetric, but for a quarter of the first body's shortest
/// edge: a section along the faces of elements would be ragged.
#[must_use]
pub fn symmetry_plane(simulation: &Simulation) -> Plane {
    let edge = simulation.sizes(0).1.into_iter().fold(f64::INFINITY, f64::min);
    Plane { point: [0.0, 0.0, 0.25 * edge], normal: [0.0, 0.0, 1.0] }
}

/// Share of the particles in elements beyond either end of each axis that need not be seen: single
/// elements fly far too.
const LOST: f64 = 0.0002;

/// The box that holds what elements hold, and the loose particles but for a share of them beyond either
/// end of each axis: scattered debris would make everything else small.
#[must_use]
pub fn frame(simulation: &Simulation, share: f64) -> [[f64; 3]; 2] {
    let (held, loose): (Vec<Particle>, Vec<Particle>) =
        simulation.all_particles().partition(|p| p.held > 0.0);
    let pad = (0..simulation.bodies()).map(|body| simulation.sizes(body).0).fold(0.0, f64::max);
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (particles, share) in [(held, LOST), (loose, share)] {
        for (axis, (low, high)) in low.iter_mut().zip(&mut high).enumerate() {
            let mut along: Vec<f64> = particles.iter().map(|p| p.position[axis]).collect();
            along.sort_unstable_by(f64::total_cmp);
            let out = (along.len() as f64 * share) as usize;
            let kept = along.get(out..along.len().saturating_sub(out)).unwrap_or_default();
            if let [first, .., last] = kept {
                *low = low.min(first - pad);
                *high = high.max(last + pad);
            }
        }
    }
    [low, high]
}

/// Live elements as hexahedra, particles without live elements as spheres or ellipsoids as wide as a
/// contact is long. The value of a mark is the plastic strain or damage of an element if that is shown, otherwise
/// what is shown of a particle, or its mean over an element by mass.
#[must_use]
pub fn model(simulation: &Simulation, shown: Shown) -> Model {
    let particles: Vec<Particle> = simulation.all_particles().collect();
    let at = places(&particles);
    let particle = |id: u32| &particles[at[id as usize] as usize];
    let elements = simulation.all_elements().filter(|element| element.live);
    let mean = |element: &Element| {
        let corners: f64 = element.corners.iter().map(|&id| shown.of(particle(id))).sum();
        0.5 * shown.of(particle(element.centre)) + 0.0625 * corners
    };
    let hexahedron = |element: Element| {
        let value = match shown {
            Shown::PlasticStrain(_) => element.strain,
            Shown::Damage => element.damage,
            _ => mean(&element),
        };
        Hexahedron {
            nodes: element.ring().map(|id| at[id as usize]),
            mark: Mark { value: value as f32, class: class(element.body) },
        }
    };
    let hexahedra = elements.map(hexahedron).collect();
    let radii: Vec<f64> =
        (0..simulation.bodies()).map(|body| 0.5 * simulation.sizes(body).0).collect();
    let mark = |p: &Particle| Mark { value: shown.of(p) as f32, class: class(p.body) };
    let (mut spheres, mut ellipsoids) = (Vec::new(), Vec::new());
    for p in particles.iter().filter(|p| p.held == 0.0) {
        let centre = p.position;
        match simulation.ellipsoid(p.id) {
            None => spheres.push(Sphere { centre, radius: radii[p.body], mark: mark(p) }),
            Some(shape) => ellipsoids.push(Ellipsoid {
                centre,
                half_axes: shape.contact_lengths.map(|length| 0.5 * length),
                directions: shape.axes,
                mark: mark(p),
            }),
        }
    }
    let points = particles.iter().map(|p| p.position).collect();
    Model { points, spheres, hexahedra, ellipsoids }
}

/// Share of the particles whose values may lie beyond either end of a colour bar: single ones that fly
/// squeezed or fast would make all else one colour.
const BEYOND: f64 = 0.005;

/// The values at the ends of a colour bar; none where nearly all are the same.
fn range(simulation: &Simulation, shown: Shown) -> Option<(f64, f64)> {
    let values = simulation.all_particles().map(|p| shown.of(&p));
    let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    values.sort_unstable_by(f64::total_cmp);
    let out = (values.len() as f64 * BEYOND) as usize;
    let kept = values.get(out..values.len().saturating_sub(out))?;
    let (low, high) = (*kept.first()?, *kept.last()?);
    (low < high).then_some((low, high))
}

/// Turns the classes of a model from bodies into materials.
fn by_material(model: &mut Model, scene: &Scene) {
    let own = |body: &whipple_solver::space::scene::Body| scene.material_index(&body.material);
    let classes: Vec<u8> = scene.bodies.iter().map(|body| class(own(body).unwrap_or(0))).collect();
    let turn = |mark: &mut Mark| {
        mark.class = classes.get(usize::from(mark.class)).copied().unwrap_or(mark.class);
    };
    model.hexahedra.iter_mut().for_each(|hexahedron| turn(&mut hexahedron.mark));
    model.spheres.iter_mut().for_each(|sphere| turn(&mut sphere.mark));
    model.ellipsoids.iter_mut().for_each(|ellipsoid| turn(&mut ellipsoid.mark));
}

/// Class of a body.
fn class(body: usize) -> u8 {
    body.min(usize::from(u8::MAX)) as u8
}

/// Paints the present state as PNG files, for light and for dark pages.
///
/// # Errors
/// As [`paint`].
pub fn shoot(
    simulation: &Simulation,
    scene: &Scene,
    shot: &Shot,
) -> Result<[Vec<u8>; 2], PaintError> {
    let field = |name: &str, unit: &str, range: Option<(f64, f64)>| {
        let (name, unit) = (name.to_owned(), unit.to_owned());
        Colouring::Field(Field { name, unit, range, map: ColourMap::Viridis })
    };
    let unit = |dimension: Dimension| scene.units.label(dimension);
    let most = range(simulation, shot.shown);
    let colouring = match shot.shown {
        Shown::Material => {
            Colouring::Classes(scene.materials.iter().map(|m| m.name.clone()).collect())
        }
        Shown::Velocity => field("speed", unit(Dimension::Velocity), most),
        Shown::Pressure => field("pressure", unit(Dimension::Pressure), most),
        Shown::Density => field("density", unit(Dimension::Density), most),
        Shown::Damage => field("damage", "", Some((0.0, 1.0))),
        Shown::Body => Colouring::Classes(scene.bodies.iter().map(|b| b.name.clone()).collect()),
        Shown::Temperature(range) => Colouring::Field(Field {
            name: "temperature".to_owned(),
            unit: scene.units.label(Dimension::Temperature).to_owned(),
            range,
            map: ColourMap::Heat,
        }),
        Shown::PlasticStrain(range) => field("effective plastic strain", "", range),
    };
    let unit = match scene.units.label(Dimension::Length) {
        "" => "units of length",
        unit => unit,
    };
    let unit = unit.to_owned();
    let before = simulation.time() == 0.0 && shot.section.is_none();
    let light = Picture {
        section: shot.section,
        arrow: flight(scene).filter(|_| before),
        title: shot.title.clone(),
        time: time(simulation.time(), scene.units),
        length: Length { unit, factor: 1.0 },
        ..Picture::new(shot.camera, colouring)
    };
    let dark = Picture { theme: Theme::Dark, ..light.clone() };
    let mut model = model(simulation, shot.shown);
    if shot.shown == Shown::Material {
        by_material(&mut model, scene);
    }
    if !shot.loose {
        model.spheres.clear();
        model.ellipsoids.clear();
    }
    if let Some([low, high]) = shot.camera.frame {
        // None is cut in half by the edge of the picture.
        let inside = |x: &[f64; 3]| (0..3).all(|d| low[d] <= x[d] && x[d] <= high[d]);
        model.spheres.retain(|sphere| inside(&sphere.centre));
        model.ellipsoids.retain(|ellipsoid| inside(&ellipsoid.centre));
    }
    Ok([paint(&model, &light)?, paint(&model, &dark)?])
}

/// Length of the arrow behind what flies, and its distance from it, over the shortest edge of a box round it.
const ARROW: [f64; 2] = [2.0, 0.2];

/// Tail and head of an arrow that points along the way of the first body at its rear, if it flies at one at rest.
fn flight(scene: &Scene) -> Option<[[f64; 3]; 2]> {
    let (first, others) = scene.bodies.split_first()?;
    let speed = first.velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
    let hits = others.iter().any(|body| body.velocity == [0.0; 3]);
    if !hits || speed == 0.0 {
        return None;
    }
    let extent = first.shape.extent();
    let [longest, shortest] =
        [f64::max, f64::min].map(|pick| extent[1..].iter().copied().fold(extent[0], pick));
    let behind = |distance: f64| -> [f64; 3] {
        std::array::from_fn(|d| first.centre[d] - distance * first.velocity[d] / speed)
    };
    let head = 0.5 * longest + ARROW[1] * shortest;
    Some([behind(head + ARROW[0] * shortest), behind(head)])
}

/// The time of a state, as the picture says it.
fn time(time: f64, units: Units) -> String {
    // Four digits, but all before the point.
    let digits = 3 - time.abs().max(1e-300).log10().floor().clamp(-300.0, 3.0) as i32;
    let scale = 10f64.powi(digits);
    let rounded = (time * scale).round() / scale;
    format!("t = {rounded} {}", units.label(Dimension::Time)).trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use whipple_solver::method::Preset;

    /// The arrow ends behind the sphere, on its way; two cubes that meet have none, nor has a body alone.
    #[test]
    fn arrows_follow_what_flies_at_a_body_at_rest() {
        let scene = crate::cases::find("rcc-plate").expect("a case").scene(Preset::Default, "", 4);
        let mut scene = scene.space().expect("in space").clone();
        let [tail, head] = flight(&scene).expect("an arrow");
        let sphere = &scene.bodies[0];
        let way: [f64; 3] = std::array::from_fn(|d| head[d] - tail[d]);
        let turned = [way[1] * sphere.velocity[0], way[0] * sphere.velocity[1]];
        assert!((turned[0] - turned[1]).abs() < 1e-12 && way[1] > 0.0, "{way:?}");
        let off = (0..3).map(|d| (head[d] - sphere.centre[d]).powi(2)).sum::<f64>().sqrt();
        let radius = 0.5 * sphere.shape.extent()[0];
        assert!(radius < off && off < 2.0 * radius, "{off}");
        scene.bodies[1].velocity = [0.0, -0.1, 0.0];
        assert_eq!(flight(&scene), None);
        scene.bodies.truncate(1);
        assert_eq!(flight(&scene), None);
    }

    #[test]
    fn times_have_four_digits_and_all_before_the_point() {
        let said = |t: f64| time(t, Units::CmGUsMbar);
        assert_eq!(said(167.1981), "t = 167.2 µs");
        assert_eq!(said(0.0), "t = 0 µs");
        assert_eq!(said(0.012_345_6), "t = 0.01235 µs");
        assert_eq!(said(12_345.6), "t = 12346 µs");
        assert_eq!(time(0.6, Units::None), "t = 0.6");
    }
}
