//! The form of a scene file, as it is written. Numbers with units are texts here; [`super::build`] reads them.

use schemars::JsonSchema;
use serde::Deserialize;
use whipple_solver::units::Units;

use super::schema::{self, Spanned};

/// A number with its unit, as text; a bare number stands for itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Text(pub String);

/// A quantity and where it stands.
pub type Quantity = Spanned<Text>;

impl<'de> Deserialize<'de> for Text {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl serde::de::Visitor<'_> for Reader {
            type Value = Text;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a number with its unit in quotes, such as \"7 km/s\"")
            }
            fn visit_str<E>(self, text: &str) -> Result<Text, E> {
                Ok(Text(text.to_owned()))
            }
            fn visit_f64<E>(self, number: f64) -> Result<Text, E> {
                Ok(Text(number.to_string()))
            }
            fn visit_i64<E>(self, number: i64) -> Result<Text, E> {
                Ok(Text(number.to_string()))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// A scene.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "Whipple scene file")]
pub struct SceneFile {
    /// What it is, in a sentence or two.
    pub about: Option<String>,
    /// The unit system of the run: what bare numbers of `--set` and of CSV files are in.
    #[serde(default = "usual")]
    #[schemars(schema_with = "schema::units")]
    pub units: Units,
    /// When the run ends.
    pub stop: Quantity,
    /// Ends the run sooner.
    pub until: Option<Spanned<Until>>,
    /// How fine the bodies are.
    pub resolution: Spanned<Resolution>,
    /// Numerical choices.
    #[serde(default)]
    pub method: Choices,
    /// Materials of this scene.
    #[serde(default)]
    pub material: Vec<Spanned<Material>>,
    /// Bodies.
    #[serde(default)]
    pub body: Vec<Spanned<Body>>,
    /// Plates in layers.
    #[serde(default)]
    pub stack: Vec<Spanned<Stack>>,
    /// Plane walls.
    #[serde(default)]
    pub wall: Vec<Spanned<Wall>>,
    /// Places that are looked at.
    #[serde(default)]
    pub probe: Vec<Spanned<Probe>>,
    /// What the run leaves.
    #[serde(default)]
    pub output: Output,
}

fn usual() -> Units {
    Units::CmGUsMbar
}

/// How fine the bodies are: one of these.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("minProperties" = 1, "maxProperties" = 1))]
pub struct Resolution {
    /// Edge of the cells.
    pub cell: Option<Quantity>,
    /// Cells through the thinnest part of any body.
    pub through: Option<usize>,
    /// About so many particles in all.
    pub particles: Option<usize>,
}

/// Numerical choices.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Choices {
    /// Of the method, what `--set` can change.
    #[serde(default)]
    #[schemars(with = "serde_json::Map<String, serde_json::Value>")]
    pub set: toml::Table,
}

/// What ends a run before its time.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Until {
    /// Some mass of a body is beyond a plane across an axis: a part of its mass, in the sense of its flight.
    Beyond(Beyond),
    /// All kinetic energy is less than this part of that at the start.
    KineticBelow(Quantity),
    /// The velocity of a body is less than this.
    Slower(Slower),
}

/// Mass of a body beyond a plane.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Beyond {
    /// Body.
    pub body: Spanned<String>,
    /// Axis.
    pub axis: Axis,
    /// Place on it.
    pub at: Quantity,
    /// Part of its mass.
    pub part: Quantity,
}

/// A body that comes to rest.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Slower {
    /// Body.
    pub body: Spanned<String>,
    /// Its velocity.
    pub than: Quantity,
}

/// A coordinate axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// First.
    X,
    /// Second.
    Y,
    /// Third.
    Z,
}

impl Axis {
    /// 0, 1 or 2.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }
}

/// A body: one shape, and what it is made of.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = schema::one_shape)]
pub struct Body {
    /// Name, in results.
    pub name: Spanned<String>,
    /// Its material: of this file, or of the library.
    pub material: Spanned<String>,
    /// A sphere.
    pub sphere: Option<Sphere>,
    /// A box; plates too.
    #[serde(rename = "box")]
    pub block: Option<Block>,
    /// A cylinder, along z before it is turned.
    pub cylinder: Option<Cylinder>,
    /// A ring or tube, along z before it is turned.
    pub ring: Option<Ring>,
    /// A cone, along z before it is turned.
    pub cone: Option<Cone>,
    /// A closed surface from a file, filled with cells.
    pub stl: Option<Stl>,
    /// Where its centre is; at the origin without.
    pub at: Option<[Quantity; 3]>,
    /// Its turn about its centre.
    pub turn: Option<Turn>,
    /// Its velocity; at rest without.
    pub velocity: Option<[Quantity; 3]>,
    /// Its angular velocity about its centre.
    pub spin: Option<[Quantity; 3]>,
    /// Heat per mass at the start.
    pub energy: Option<Quantity>,
    /// Edge of its cells, if it has its own.
    pub cell: Option<Quantity>,
    /// Cells along its own axes, if they are not to be found from their edge.
    pub cells: Option<[usize; 3]>,
}

/// A sphere.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Diameter.
    pub diameter: Quantity,
}

/// A box.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Edges along x, y, z before it is turned.
    pub size: [Quantity; 3],
}

/// A cylinder.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// Diameter.
    pub diameter: Quantity,
    /// Length.
    pub length: Quantity,
}

/// A ring.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ring {
    /// Outer diameter.
    pub outer: Quantity,
    /// Inner diameter.
    pub inner: Quantity,
    /// Length.
    pub length: Quantity,
}

/// A cone.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cone {
    /// Diameter at its lower end.
    pub lower: Quantity,
    /// Diameter at its upper end; pointed without.
    pub upper: Option<Quantity>,
    /// Length.
    pub length: Quantity,
}

/// A surface from a file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stl {
    /// File, from the folder of the scene file on.
    pub file: Spanned<String>,
    /// Length of its numbers.
    pub unit: Quantity,
}

/// A turn about an axis through the centre.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Turn {
    /// Axis, of any length.
    pub axis: [f64; 3],
    /// Angle.
    pub angle: Quantity,
}

/// Plates one behind the other.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stack {
    /// Name, which layers number.
    pub name: Spanned<String>,
    /// Axis across the plates, along which they follow each other.
    pub axis: Axis,
    /// Where the first face is, and the middle of the plates across the axis.
    pub at: [Quantity; 3],
    /// Edges of the plates across the axis, in the order of the axes.
    pub size: [Quantity; 2],
    /// Layers from the first face on.
    pub layer: Vec<Layer>,
}

/// A layer.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// Its material.
    pub material: Spanned<String>,
    /// Its thickness.
    pub thickness: Quantity,
    /// Gap before it; none before the first, else half a cell, at which bodies begin to feel each other.
    pub gap: Option<Quantity>,
    /// Edge of its cells, if it has its own.
    pub cell: Option<Quantity>,
}

/// A plane, rigid wall without friction.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Axis across it.
    pub axis: Axis,
    /// Where it is.
    pub at: Quantity,
    /// Side of it that bodies are on.
    pub bodies: Side,
    /// What it is.
    pub kind: WallKind,
}

/// A side of a plane.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// At larger coordinates.
    Above,
    /// At smaller coordinates.
    Below,
}

/// What a wall is.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WallKind {
    /// A plane of symmetry: what starts on it stays.
    Mirror,
    /// An anvil, which bodies may leave.
    Rigid,
}

/// What is looked at, over time.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Name, in results.
    pub name: Spanned<String>,
    /// The particle that is nearest to this place at the start: it goes along.
    pub point: Option<[Quantity; 3]>,
    /// Mass and momentum beyond a plane.
    pub plane: Option<Plane>,
    /// A body: its centre, velocity and energy.
    pub body: Option<Spanned<String>>,
}

/// A plane across an axis.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// Axis across it.
    pub axis: Axis,
    /// Where it is.
    pub at: Quantity,
}

/// What a run leaves.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Time between two entries of the histories; a two-hundredth of the run without.
    pub every: Option<Quantity>,
    /// Times of pictures; start and end without.
    pub pictures: Option<Vec<Quantity>>,
    /// What colours them.
    pub colour: Option<Colour>,
    /// Axis across the plane through the origin in which pictures are cut, besides whole ones; y without.
    pub section: Option<Axis>,
}

/// What colours a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Colour {
    /// The body.
    Body,
    /// The temperature.
    Temperature,
    /// The effective plastic strain.
    PlasticStrain,
}

/// A material.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name.
    pub name: Spanned<String>,
    /// What it is.
    pub title: Option<String>,
    /// Density at rest.
    pub density: Quantity,
    /// Where the density comes from.
    pub source: Option<String>,
    /// Solids: Mie-Grueneisen on a straight shock Hugoniot.
    pub solid: Option<Solid>,
    /// Ideal gases.
    pub gas: Option<Gas>,
    /// Resistance to shear; none without.
    pub strength: Option<Strength>,
    /// What makes it fail.
    pub failure: Option<Failure>,
}

/// Whether a source was read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Read in the source that is named.
    #[default]
    Read,
    /// From memory: to be looked up.
    Recalled,
    /// A choice, with its reason.
    Chosen,
}

/// Equation of state of a solid, `U_s = c0 + s u_p`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// Bulk sound speed.
    pub c0: Quantity,
    /// Slope.
    pub s: f64,
    /// Grueneisen coefficient at rest density.
    pub gamma_0: f64,
    /// Its change with the compression, Steinberg's `b`; its product with the density is constant without.
    pub b: Option<f64>,
    /// Specific heat.
    pub c_v: Quantity,
    /// Temperature at rest; 300 K without.
    pub theta_0: Option<Quantity>,
    /// Where the constants come from.
    pub source: Option<String>,
    /// Whether that was read.
    #[serde(default)]
    pub status: Status,
    /// Pressure up to which they are good.
    pub valid_to: Option<Quantity>,
}

/// Equation of state of a gas.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gas {
    /// Ratio of specific heats.
    pub index: f64,
    /// Specific heat.
    pub c_v: Quantity,
    /// Where the constants come from.
    pub source: Option<String>,
    /// Whether that was read.
    #[serde(default)]
    pub status: Status,
}

/// Resistance to shear.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Strength {
    /// Shear modulus.
    pub shear_modulus: Quantity,
    /// The paper's law, `Y0 (1 + kappa eps)^alpha (1 - eta theta_H)`.
    pub hardening: Option<Hardening>,
    /// Johnson and Cook's law.
    pub johnson_cook: Option<JohnsonCook>,
    /// A constant yield stress.
    pub yield_stress: Option<Quantity>,
    /// Where the constants come from.
    pub source: Option<String>,
    /// Whether that was read.
    #[serde(default)]
    pub status: Status,
    /// Temperature up to which they are good.
    pub valid_to: Option<Quantity>,
}

/// The paper's law of the yield stress.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hardening {
    /// Yield stress at rest.
    pub y_0: Quantity,
    /// Hardening coefficient.
    pub kappa: f64,
    /// Hardening exponent.
    pub alpha: f64,
    /// Thermal softening; 1 without.
    pub eta: Option<f64>,
    /// Temperature from which on it softens; 300 K without.
    pub reference: Option<Quantity>,
    /// Melt temperature.
    pub melt: Quantity,
}

/// Johnson and Cook's law of the yield stress.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JohnsonCook {
    /// Yield stress.
    pub a: Quantity,
    /// Hardening.
    pub b: Quantity,
    /// Hardening exponent.
    pub n: f64,
    /// Rate coefficient.
    pub c: f64,
    /// Reference strain rate; 1 1/s without.
    pub rate_0: Option<Quantity>,
    /// Exponent of the softening.
    pub m: f64,
    /// Temperature from which on it softens; 300 K without.
    pub reference: Option<Quantity>,
    /// Melt temperature.
    pub melt: Quantity,
}

/// What makes a material fail; it does not without.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Failure {
    /// Effective plastic strain.
    pub plastic_strain: Option<f64>,
    /// Temperature.
    pub melt: Option<Quantity>,
    /// Volume over that at rest; 0.3 without.
    pub compression: Option<f64>,
    /// Tensile (spall) strength.
    pub spall: Option<Quantity>,
    /// Where the constants come from.
    pub source: Option<String>,
    /// Whether that was read.
    #[serde(default)]
    pub status: Status,
}
