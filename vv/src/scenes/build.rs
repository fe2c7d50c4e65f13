//! A scene file made into the scene that runs.

use std::ops::Range as Span;
use std::path::{Path, PathBuf};

use whipple_solver::space::lattice::cell_size;
use whipple_solver::space::scene::{Body, Hold, Material as Data, Scene, Shape, Side, Turn, Wall};
use whipple_solver::units::Units;

use super::error::FileError;
use super::file::{self, Quantity, SceneFile};
use super::material::{self, Range};
use super::quantity::{self, Kind};
use super::schema::Spanned;
use super::stl;
use crate::nesting::{DEEPEST, too_deep};
use crate::suggest::did_you_mean;

/// Gap between layers that touch, over the edge of the larger cells: from half an edge on bodies feel each other.
const TOUCHING: f64 = 0.51;

/// Most cells that a resolution may ask for across one axis of a body.
const MOST_ACROSS: f64 = 16_000.0;

/// A file that is being read: its text, for messages, and the units of its scene.
#[derive(Debug, Clone)]
pub struct Reading<'a> {
    path: &'a Path,
    text: &'a str,
    /// Units of the scene.
    pub units: Units,
}

impl<'a> Reading<'a> {
    /// Of a file.
    #[must_use]
    pub fn new(path: &'a Path, text: &'a str, units: Units) -> Self {
        Self { path, text, units }
    }

    /// An error at a place of the file.
    #[must_use]
    pub fn wrong(&self, span: Span<usize>, message: String) -> FileError {
        FileError::at(self.path, self.text, span, message)
    }

    /// A text that no file states.
    pub(super) fn plain(&self, text: &str, kind: Kind) -> Result<f64, String> {
        quantity::read(text, kind, self.units)
    }

    /// A number in the units of the scene.
    ///
    /// # Errors
    /// What is wrong with it, and where it stands.
    pub fn read(&self, quantity: &Quantity, kind: Kind) -> Result<f64, FileError> {
        self.plain(&quantity.get_ref().0, kind).map_err(|why| self.wrong(quantity.span(), why))
    }

    /// The same, above zero.
    ///
    /// # Errors
    /// As [`Reading::read`].
    pub fn positive(&self, quantity: &Quantity, kind: Kind) -> Result<f64, FileError> {
        let value = self.read(quantity, kind)?;
        if value > 0.0 {
            return Ok(value);
        }
        let why = format!(
            "`{}` is not above zero: wanted {} such as \"{}\"",
            quantity.get_ref().0,
            kind.name,
            kind.example
        );
        Err(self.wrong(quantity.span(), why))
    }

    /// A number, or another where none is given.
    ///
    /// # Errors
    /// As [`Reading::read`].
    pub fn or(
        &self,
        quantity: Option<&Quantity>,
        kind: Kind,
        other: f64,
    ) -> Result<f64, FileError> {
        quantity.map_or(Ok(other), |quantity| self.read(quantity, kind))
    }

    fn vector(&self, all: Option<&[Quantity; 3]>, kind: Kind) -> Result<[f64; 3], FileError> {
        let Some([x, y, z]) = all else { return Ok([0.0; 3]) };
        Ok([self.read(x, kind)?, self.read(y, kind)?, self.read(z, kind)?])
    }
}

/// A scene from a file.
#[derive(Debug, Clone)]
pub struct Built {
    /// As written.
    pub file: SceneFile,
    /// Where.
    pub path: PathBuf,
    /// The text.
    pub text: String,
    /// What runs.
    pub scene: Scene,
    /// Up to where the constants of its materials are good, in their order.
    pub ranges: Vec<Range>,
    /// Cells through the thinnest part of any body.
    pub through: usize,
    /// What is to be said of it.
    pub notes: Vec<String>,
}

/// A body, and how fine it is to be.
struct Draft {
    body: Body,
    cell: Option<f64>,
    given: Option<[usize; 3]>,
    span: Span<usize>,
    /// The surface of a file that it fills.
    surface: Option<stl::Surface>,
    /// Axis of the stack in which it follows the body before, and the gap to that; none for touching.
    follows: Option<(usize, Option<f64>)>,
}

impl Built {
    /// Reads a scene file; `through` is another number of cells through the thinnest part.
    ///
    /// # Errors
    /// What is wrong with it, and where.
    pub fn read(path: &Path, through: Option<usize>) -> Result<Self, FileError> {
        let text = std::fs::read_to_string(path)
            .map_err(|error| FileError::whole(path, format!("cannot be read: {error}")))?;
        Self::of(path, &text, through)
    }

    /// The same of a text.
    ///
    /// # Errors
    /// What is wrong with it, and where.
    pub fn of(path: &Path, text: &str, through: Option<usize>) -> Result<Self, FileError> {
        if let Some(at) = too_deep(text) {
            let why =
                format!("more than {DEEPEST} brackets are open here: one before is not closed");
            return Err(FileError::at(path, text, at..at + 1, why));
        }
        let file: SceneFile =
            toml::from_str(text).map_err(|error| FileError::toml(path, text, &error))?;
        let of = Reading::new(path, text, file.units);
        let mut drafts = Vec::new();
        for body in &file.body {
            drafts.push(draft(&of, body)?);
        }
        for stack in &file.stack {
            layers(&of, stack, &mut drafts)?;
        }
        if drafts.is_empty() {
            let why = "there is no body: wanted a [[body]] or a [[stack]]".to_owned();
            return Err(FileError::whole(path, why));
        }
        unique(&of, &file, &drafts)?;
        let (materials, ranges, notes) = materials(&of, &file, &drafts)?;
        let thin = drafts.iter().map(thickness).fold(f64::INFINITY, f64::min);
        let edge = match through {
            Some(n) => thin / n as f64,
            None => edge(&of, &file, &drafts, thin)?,
        };
        let bodies = placed(drafts, edge, &of)?;
        let mut walls = Vec::new();
        for wall in &file.wall {
            walls.push(wall_of(&of, wall.get_ref())?);
        }
        let scene = Scene {
            name: stem(path),
            units: file.units,
            stop_time: of.positive(&file.stop, Kind::TIME)?,
            method: whipple_solver::method::Preset::Default.space(),
            walls,
            materials,
            bodies,
        };
        let through = (thin / edge).round().max(1.0) as usize;
        Ok(Self {
            path: path.to_owned(),
            text: text.to_owned(),
            file,
            scene,
            ranges,
            through,
            notes,
        })
    }

    /// For messages about places of the file.
    #[must_use]
    pub fn reading(&self) -> Reading<'_> {
        Reading::new(&self.path, &self.text, self.file.units)
    }
}

/// Name of a file without its ending.
fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

fn draft(of: &Reading<'_>, body: &Spanned<file::Body>) -> Result<Draft, FileError> {
    let (span, body) = (body.span(), body.get_ref());
    let mut shapes = Vec::new();
    if let Some(own) = &body.sphere {
        shapes.push(Shape::Sphere { diameter: of.positive(&own.diameter, Kind::LENGTH)? });
    }
    if let Some(own) = &body.block {
        let [x, y, z] = &own.size;
        let edge = |edge| of.positive(edge, Kind::LENGTH);
        shapes.push(Shape::Box { size: [edge(x)?, edge(y)?, edge(z)?] });
    }
    if let Some(own) = &body.cylinder {
        shapes.push(Shape::Cylinder {
            diameter: of.positive(&own.diameter, Kind::LENGTH)?,
            length: of.positive(&own.length, Kind::LENGTH)?,
        });
    }
    if let Some(own) = &body.ring {
        shapes.push(Shape::Ring {
            outer: of.positive(&own.outer, Kind::LENGTH)?,
            inner: of.positive(&own.inner, Kind::LENGTH)?,
            length: of.positive(&own.length, Kind::LENGTH)?,
        });
    }
    if let Some(own) = &body.cone {
        shapes.push(Shape::Cone {
            lower: of.read(&own.lower, Kind::LENGTH)?,
            upper: of.or(own.upper.as_ref(), Kind::LENGTH, 0.0)?,
            length: of.positive(&own.length, Kind::LENGTH)?,
        });
    }
    let (mut own_centre, mut surface) = ([0.0; 3], None);
    if let Some(own) = &body.stl {
        let folder = of.path.parent().unwrap_or(Path::new(""));
        let unit = of.positive(&own.unit, Kind::LENGTH)?;
        let read = stl::Surface::read(&folder.join(own.file.get_ref()), unit);
        let read = read.map_err(|why| of.wrong(own.file.span(), why))?;
        own_centre = read.centre();
        // Filled when the cells are known.
        shapes.push(Shape::Filled { size: read.size(), volume: read.volume(), runs: Vec::new() });
        surface = Some(read);
    }
    let [shape] = &shapes[..] else {
        let why = format!(
            "the body `{}` needs one shape: `sphere`, `box`, `cylinder`, `ring`, `cone` or `stl`; it has {}",
            body.name.get_ref(),
            shapes.len()
        );
        return Err(of.wrong(span, why));
    };
    let turn = match &body.turn {
        None => Turn::default(),
        Some(turn) => {
            Turn { axis: turn.axis, degrees: of.read(&turn.angle, Kind::ANGLE)?.to_degrees() }
        }
    };
    // A surface from a file lies where the file has it.
    let given = of.vector(body.at.as_ref(), Kind::LENGTH)?;
    let centre = std::array::from_fn(|d| given[d] + own_centre[d]);
    Ok(Draft {
        body: Body {
            centre,
            turn,
            velocity: of.vector(body.velocity.as_ref(), Kind::VELOCITY)?,
            spin: of.vector(body.spin.as_ref(), Kind::SPIN)?,
            energy: of.or(body.energy.as_ref(), Kind::SPECIFIC_ENERGY, 0.0)?,
            ..resting(body.name.get_ref(), body.material.get_ref(), shape.clone())
        },
        cell: body.cell.as_ref().map(|cell| of.positive(cell, Kind::LENGTH)).transpose()?,
        given: body.cells,
        span,
        surface,
        follows: None,
    })
}

/// The plates of a stack; where they lie along its axis is known when their cells are.
fn layers(
    of: &Reading<'_>,
    stack: &Spanned<file::Stack>,
    drafts: &mut Vec<Draft>,
) -> Result<(), FileError> {
    let (span, stack) = (stack.span(), stack.get_ref());
    let axis = stack.axis.index();
    let [x, y, z] = &stack.at;
    let at = [of.read(x, Kind::LENGTH)?, of.read(y, Kind::LENGTH)?, of.read(z, Kind::LENGTH)?];
    let [a, b] = &stack.size;
    let mut across = [of.positive(a, Kind::LENGTH)?, of.positive(b, Kind::LENGTH)?].into_iter();
    let name = stack.name.get_ref();
    let edges: [f64; 3] =
        std::array::from_fn(|d| if d == axis { 0.0 } else { across.next().unwrap_or(0.0) });
    for (k, layer) in stack.layer.iter().enumerate() {
        let mut size = edges;
        size[axis] = of.positive(&layer.thickness, Kind::LENGTH)?;
        let gap = layer.gap.as_ref().map(|gap| of.read(gap, Kind::LENGTH)).transpose()?;
        let mut centre = at;
        centre[axis] += gap.unwrap_or(0.0) + 0.5 * size[axis];
        let number = if stack.layer.len() == 1 { String::new() } else { format!("-{}", k + 1) };
        drafts.push(Draft {
            body: Body {
                centre,
                ..resting(&format!("{name}{number}"), layer.material.get_ref(), Shape::Box { size })
            },
            cell: layer.cell.as_ref().map(|cell| of.positive(cell, Kind::LENGTH)).transpose()?,
            given: None,
            span: span.clone(),
            surface: None,
            follows: (k > 0).then_some((axis, gap)),
        });
    }
    Ok(())
}

/// A body at rest at the origin, of one cell until more is known.
fn resting(name: &str, material: &str, shape: Shape) -> Body {
    Body {
        name: name.into(),
        material: material.into(),
        shape,
        cells: [1; 3],
        centre: [0.0; 3],
        turn: Turn::default(),
        velocity: [0.0; 3],
        spin: [0.0; 3],
        energy: 0.0,
        noise: 0.0,
        mapping: None,
    }
}

/// Refuses two bodies of one name.
fn unique(of: &Reading<'_>, file: &SceneFile, drafts: &[Draft]) -> Result<(), FileError> {
    for (k, draft) in drafts.iter().enumerate() {
        if drafts[..k].iter().any(|other| other.body.name == draft.body.name) {
            let why = format!("a body `{}` is there already: names must differ", draft.body.name);
            let span =
                file.body.get(k).map_or(draft.span.clone(), |body| body.get_ref().name.span());
            return Err(of.wrong(span, why));
        }
    }
    Ok(())
}

/// Materials, up to where their constants are good, and what is to be said of them.
type Materials = (Vec<Data>, Vec<Range>, Vec<String>);

/// The materials that bodies name.
fn materials(of: &Reading<'_>, file: &SceneFile, drafts: &[Draft]) -> Result<Materials, FileError> {
    let library = material::library()?;
    let (mut all, mut ranges, mut notes) = (Vec::<Data>::new(), Vec::new(), Vec::new());
    let own = file.body.iter().map(|body| &body.get_ref().material);
    let layers = file.stack.iter().flat_map(|stack| &stack.get_ref().layer).map(|l| &l.material);
    for (name, draft) in own.chain(layers).zip(drafts) {
        debug_assert_eq!(name.get_ref(), &draft.body.material);
        if all.iter().any(|known| known.name == *name.get_ref()) {
            continue;
        }
        let is = |material: &&Spanned<file::Material>| {
            material.get_ref().name.get_ref() == name.get_ref()
        };
        let (data, range) = if let Some(own) = file.material.iter().find(is) {
            material::data(of, own)?
        } else if let Some(known) = library.iter().find(is) {
            for (what, source, status) in material::sources(known.get_ref()) {
                if status == file::Status::Recalled {
                    let name = name.get_ref();
                    notes.push(format!(
                        "the {what} of `{name}` was not read in a source ({source})"
                    ));
                }
            }
            material::data(&material::reading(of.units), known)?
        } else {
            let known = file.material.iter().chain(library);
            let known = known.map(|material| material.get_ref().name.get_ref().as_str());
            let hint = did_you_mean(name.get_ref(), known);
            let why = format!(
                "there is no material `{}`{hint} (`whipple material list` names those of the library; a [[material]] \
                 of the file may be another)",
                name.get_ref()
            );
            return Err(of.wrong(name.span(), why));
        };
        all.push(data);
        ranges.push(range);
    }
    Ok((all, ranges, notes))
}

/// The thinnest extent of a body: the wall of a ring, an edge of a box.
fn thickness(draft: &Draft) -> f64 {
    let least = draft.body.shape.extent().into_iter().fold(f64::INFINITY, f64::min);
    match draft.body.shape {
        Shape::Ring { outer, inner, .. } => least.min(0.5 * (outer - inner)),
        _ => least,
    }
}

/// Edge of the cells by the resolution of the file.
fn edge(of: &Reading<'_>, file: &SceneFile, drafts: &[Draft], thin: f64) -> Result<f64, FileError> {
    let own = file.resolution.get_ref();
    match (&own.cell, own.through, own.particles) {
        (Some(cell), None, None) => of.positive(cell, Kind::LENGTH),
        (None, Some(n), None) if n > 0 => Ok(thin / n as f64),
        (None, None, Some(n)) if n > 1 => {
            // A cell has two particles, and a body those of its surface besides: as good as it can be before cells are whole.
            let volume: f64 = drafts.iter().map(|draft| draft.body.shape.volume()).sum();
            let surface: f64 = drafts
                .iter()
                .map(|draft| {
                    let [a, b, c] = draft.body.shape.extent();
                    2.0 * (a * b + b * c + c * a)
                })
                .sum();
            let count = |edge: f64| 2.0 * volume / edge.powi(3) + 0.5 * surface / edge.powi(2);
            let (mut low, mut high) = (1e-9 * thin, 1e3 * thin);
            for _ in 0..200 {
                let middle = (low * high).sqrt();
                if count(middle) > n as f64 { low = middle } else { high = middle }
            }
            Ok((low * high).sqrt())
        }
        _ => {
            let why = "wanted one of `cell = \"0.5 mm\"` (edge of the cells), `through = 4` (cells through the thinnest \
                       part) and `particles = 50000` (about so many in all)";
            Err(of.wrong(file.resolution.span(), why.to_owned()))
        }
    }
}

/// The bodies with their cells, and layers where their gaps put them.
fn placed(drafts: Vec<Draft>, edge: f64, of: &Reading<'_>) -> Result<Vec<Body>, FileError> {
    let mut bodies: Vec<Body> = Vec::new();
    let mut before = 0.0;
    for Draft { mut body, cell, given, span, surface, follows } in drafts {
        let edge = cell.unwrap_or(edge);
        body.cells = match given {
            Some(cells) => cells,
            None => cells(&body, edge).map_err(|why| of.wrong(span, why))?,
        };
        if let (Shape::Filled { runs, .. }, Some(surface)) = (&mut body.shape, surface) {
            *runs = surface.runs(body.cells);
        }
        if let (Some((axis, gap)), Some(last)) = (follows, bodies.last()) {
            let half = 0.5 * (last.shape.extent()[axis] + body.shape.extent()[axis]);
            let gap = gap.unwrap_or(TOUCHING * edge.max(before));
            body.centre[axis] = last.centre[axis] + half + gap;
        }
        before = edge;
        bodies.push(body);
    }
    Ok(bodies)
}

/// Cells of a body along its own axes, of which one is to be as long as this.
fn cells(body: &Body, edge: f64) -> Result<[usize; 3], String> {
    let extent = body.shape.extent();
    if extent.iter().any(|&e| e / edge > MOST_ACROSS) {
        return Err(format!(
            "`{}` would have {:.0} cells across, and {MOST_ACROSS:.0} are the most",
            body.name,
            extent.iter().fold(0.0f64, |most, e| most.max(e / edge))
        ));
    }
    let about = extent.map(|e| (e / edge).round().max(1.0) as usize);
    // The lattice of a round body is a little larger or smaller than the body: of the counts about the nearest, the one
    // whose cells come nearest.
    let round = match body.shape {
        Shape::Sphere { .. } => 3,
        Shape::Cylinder { .. } | Shape::Ring { .. } | Shape::Cone { .. } => 2,
        _ => return Ok(about),
    };
    let off = |more: i64| {
        let mut cells = about;
        for n in &mut cells[..round] {
            *n = (*n as i64 + more).max(1) as usize;
        }
        let size = cell_size(&Body { cells, ..body.clone() });
        (cells, (size[0] / edge).ln().abs())
    };
    let all = (-2..=2).map(off).filter(|(_, off)| off.is_finite());
    Ok(all.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(about, |(cells, _)| cells))
}

fn wall_of(of: &Reading<'_>, wall: &file::Wall) -> Result<Wall, FileError> {
    Ok(Wall {
        axis: wall.axis.index(),
        position: of.read(&wall.at, Kind::LENGTH)?,
        material: match wall.bodies {
            file::Side::Above => Side::Above,
            file::Side::Below => Side::Below,
        },
        hold: match wall.kind {
            file::WallKind::Mirror => Hold::Mirror,
            file::WallKind::Rigid => Hold::Rest,
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_that_never_close_are_refused_before_they_are_read() {
        let text = "[[material]]\nsolid = { c0 = \"1 km/s\", s\", s =".repeat(30_000);
        let error = Built::of(Path::new("s.toml"), &text, None).err().map(|e| e.to_string());
        assert!(error.is_some_and(|e| e.contains("line 64") && e.contains("not closed")));
    }
}
