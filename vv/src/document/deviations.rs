//! Where the method departs from what is printed: what, why, and where its effect is measured.

use crate::report::{Block, Column, Section, Table};

/// A deviation: what is done instead, why, and where it is decided and measured.
type Deviation = [&'static str; 3];

/// In both presets, along a line and in space.
const COMMON: [Deviation; 5] = [
    [
        "The viscous force (51), (74) repels what approaches",
        "as printed it attracts, and dissipation is negative (G8)",
        "decision 0001",
    ],
    [
        "The pressure force (78) has the factor ρ₀²",
        "without it the force has the wrong dimension (G10)",
        "decision 0001",
    ],
    [
        "A pair has one contact coordinate, from the mean length of both, and one cut-off",
        "tests of one side alone let one particle see the other and not be seen: momentum is lost (G12)",
        "decision 0001; every balance under Conservation",
    ],
    [
        "Particles of solids push and never pull: tension belongs to segments and elements (25)",
        "both at once act twice, and particles under tension are unstable (G33)",
        "decision 0001; `kolsky`, variant `20-transits`",
    ],
    [
        "The kernel density evolves: its support follows the density, so that the number of neighbours stays \
         the same",
        "a support fixed in the reference lattice fails on the wall shock; it is solved for by iteration and \
         costs more than a plain sum would",
        "decision 0003; `noh`, `whipple bench density`",
    ],
];

/// Along a line.
const LINE: [Deviation; 6] = [
    [
        "The sums of (34) and (78) have the coefficient 1/2 and two neighbours",
        "the printed 3/8 is for the eight neighbours of three dimensions (G16)",
        "decision 0002",
    ],
    [
        "The nearest particle is in contact, between bodies while ζ < 1",
        "(35) is met with equality in every uniform state and cannot decide there (G13)",
        "decision 0003; `uniform-collapse`, `block-collision`",
    ],
    [
        "`paper`: sound speed from the total internal energy, u₀ = 1 of Table 1 included",
        "the reading that gives Table 2 (G17)",
        "decision 0004; `noh`",
    ],
    [
        "`paper`: heating as printed, in the frame of the wall; `default`: half to each particle of a pair",
        "(60) as printed depends on the frame (G9)",
        "decision 0005; `galilean-boost`",
    ],
    [
        "`default`: density of the segments; viscosity on the part of a velocity jump that the neighbours do \
         not explain",
        "overshoot and wall heating of the printed forms",
        "decisions 0003, 0006; `noh`, `sod`, `strong-shock-tube`",
    ],
    [
        "`default`: the compatible integrator, total energy conserved to round-off",
        "neither integrator nor time step are printed (G35)",
        "decision 0007; every balance under Conservation",
    ],
];

/// In space, in both presets.
const SPACE: [Deviation; 15] = [
    [
        "Contact (35) with a tolerance of 0.06, up to ζ = 1.12",
        "it is met with equality in every uniform state: without a tolerance errors of integration decide (G13)",
        "decision 0003; `lattice-kinematics`, with and without it",
    ],
    [
        "The yield function (39) to (46) is read so that the uniaxial yield stress is Y",
        "as printed it is 2.12 Y (G3); both other readings can be chosen",
        "decision 0012; `elastic-plastic-piston`, `long-rod`",
    ],
    [
        "The return map (46) is iterated to 1e-10 Y, and C^p kept at unit determinant (17)",
        "one printed step leaves a third of the overshoot (G4), and drifts off constant volume",
        "decision 0012",
    ],
    [
        "Solids harden and fail by the equivalent plastic strain",
        "the printed measure (45) is 0.866 of it (G5)",
        "decision 0012; `taylor-copper`, `taylor-42crmo4`",
    ],
    [
        "Plastic heat (61) is the trapezoidal stress times the plastic step",
        "a difference of stored energies heats threefold",
        "decision 0012; `verney`",
    ],
    [
        "Heat of elements goes half to the centroid and a sixteenth to each corner",
        "φ of (60) is not printed (G22)",
        "decision 0012",
    ],
    [
        "Viscous heat goes half to each particle of a pair, and the integrator is the compatible leapfrog, in \
         `paper` too",
        "(60) as printed depends on the frame (G9); neither integrator nor time step are printed (G35)",
        "decisions 0005, 0012; every balance under Conservation",
    ],
    [
        "The temperature is that of the isentrope through the reference state and the energy beyond it",
        "the temperature model is not printed",
        "decision 0012",
    ],
    [
        "Two flags for elements: failed, without strength or tension; and dead, no volume any more (crushed, \
         torn, flat)",
        "a molten element under pressure is still a good volume, an inverted one would stop the run",
        "decisions 0012, 0015; numbers of both under the cases",
    ],
    [
        "A solid's density does not fall below 0.3 ρ₀, an overlap of loose particles counts as 0.8 at most, and \
         fragments without contact expand until they are free of pressure",
        "debris would fly apart, freeze compressed, or set the time step",
        "decision 0012; counted as held in the records",
    ],
    [
        "The time step knows thin cells by the areas of all their faces",
        "a bound by the thickness alone takes twice the steps",
        "decision 0015; `long-rod`",
    ],
    [
        "Its stiffness and its damping are symmetric matrices of a cell; pressures stand at the positions of a step, not \
         behind them",
        "a trace instead is three times too strict in cubes and too lax at free surfaces; a pressure that lags feeds the \
         fastest waves",
        "decision 0020; every balance under Conservation, `planar-impact`",
    ],
    [
        "Before the first step rates of density are those of the speeds at hand, and walls vote on what nears them",
        "the step before has found no rate yet: halves that part at ten times their sound lost more energy than they had",
        "decision 0022; `whipple vv hard H13`",
    ],
    [
        "Rows of Table 4 with the columns of rod and plate exchanged and converted, `paper` also as printed; a \
         plate of 7 by 4 cm; constants of materials that are not printed",
        "numbers of tungsten stand under steel (G1, G2); the plate's size (G25), K, J_c and the equations of \
         state are not given (G21, G23, G24)",
        "`long-rod`, in all readings and with twice the plate",
    ],
    [
        "c₀ = 0.3 in `paper`, without a quadratic term",
        "the constants of the three-dimensional runs are not printed (G19)",
        "decision 0013; `long-rod`, variants of the viscosity",
    ],
];

/// In space, in `default`.
const SPACE_DEFAULT: [Deviation; 13] = [
    [
        "Density of particles in live elements from the volumes of the elements' own pyramids; the contact rule \
         (34) to (36) is left to loose particles",
        "in uniaxial strain the rule's density is off by up to 7 % (G14), and pressure behind shocks by a fifth \
         and more",
        "decision 0012; `lattice-kinematics`, `planar-impact` and `long-rod` in both presets",
    ],
    [
        "Pyramids weigh the corners of the opposite face too",
        "with plain means centroids accelerate at a third of the right value, corners at five thirds",
        "decision 0013; `planar-impact`",
    ],
    [
        "Viscosity and heat flux along the diagonals of cells, on the part of a jump that the neighbours do not \
         explain; constants in sample",
        "no constants of (51) to (53) met all planar impacts from 0.5 to 7 km/s",
        "decisions 0013, 0016; `planar-impact`, `spall`, `free-surface`",
    ],
    [
        "Bonds at mirrors see the image of their cell",
        "without it viscosity is uneven there, and planes warp",
        "decision 0016; `planar-impact`",
    ],
    [
        "Drag against hourglass modes in solids without strength; constant in sample",
        "planes of steel warped at 7 km/s, and finer was worse",
        "decision 0019; `planar-impact`, and `hourglass-on` of the cases that need none",
    ],
    [
        "Bodies keep each other out by springs between their live surfaces",
        "the contact rule lets lattices through each other, and springs from corners alone buckle",
        "decisions 0014, 0016; `planar-impact`, tungsten on steel",
    ],
    [
        "A node of a rim has a spring of its own where edges and corners meet in line",
        "no face lies before another there: edges and corners went through each other without a force",
        "decision 0024; `whipple vv hard W02`",
    ],
    [
        "Heat flows between a centroid and its corners where it alternates between them",
        "both change their volume alike, so that no motion levels it: half of its energy was left",
        "decision 0023; `whipple vv hard H07`",
    ],
    [
        "In expansion the particles of intact solids carry the thermal part of the pressure alone, the elements the cold \
         tension (25); spall is held against the tension less that part",
        "both at once stop warm material at half of its thermal expansion, and heat alone met its spall strength",
        "decision 0025; `whipple vv hard H05`, `spall`",
    ],
    [
        "Particles that live elements hold rotate with these; viscosity acts along diagonals scaled to the edges of the \
         cell; the viscous torque (54) is lessened to what a step bears",
        "a rotation of their own would count the inertia of the cell twice; long edges would resist 64 times as much as \
         short ones; the torque would ask for a fiftieth of the step",
        "decision 0021; `long-rod`, variants `cells-2` and `cells-4`",
    ],
    [
        "A tensile strength fails elements (spall), and a failed element loses its strength over the time in \
         which sound crosses 5 cells",
        "the list before (47) has no tensile criterion, and 20 steps make the answer depend on the step (G20)",
        "decision 0012; `spall`, `free-surface`",
    ],
    [
        "Elements of gas do not die by stretching, their pyramids resist being denser than their cell, and gas \
         has no least density",
        "Noh's implosion is beyond the limits of solids",
        "decision 0017; `noh-space`, `sedov`",
    ],
    [
        "Lattices skewed or bent by a closed form, with nodes of the mass that their pyramids give",
        "the paper has equal cells alone",
        "decision 0018; `saltzman`, `verney`",
    ],
];

/// What is in the paper and not here.
const MISSING: [&str; 3] = [
    "Along a line: rotation, shear, plasticity, damage.",
    "In three dimensions: heating (60) as printed; single-pass integration where elements carry the pressure; \
     ellipsoids in mapped lattices; torques of walls on ellipsoids (decision 0021).",
    "Spall compares a pressure with a strength that experiments give as a longitudinal stress: they differ by \
     4/3 of the shear stress. Decision 0012.",
];

/// The section.
pub(super) fn section() -> Section {
    let table = |id: &str, caption: &str, rows: &[Deviation]| {
        Block::Table(Table {
            id: id.into(),
            caption: caption.into(),
            columns: ["instead of what is printed", "why", "decided and measured"]
                .map(Column::text)
                .to_vec(),
            rows: rows.iter().map(|row| row.map(Into::into).to_vec()).collect(),
        })
    };
    let about = "Numbers in parentheses are equations of the paper; G1 to G35 are its gaps and inconsistencies, \
                 listed with what is used instead in `references/gaps.toml`; decisions stand in \
                 `references/decisions/`, with the measurements behind them; names in this type are cases of \
                 this report.";
    let blocks = vec![
        Block::Paragraph(about.into()),
        table("deviations", "Deviations in both presets, along a line and in space.", &COMMON),
        table("deviations-line", "Deviations along a line.", &LINE),
        table("deviations-space", "Deviations in three dimensions, in both presets.", &SPACE),
        table(
            "deviations-space-default",
            "Deviations in three dimensions, in `default` alone; `paper` goes without them.",
            &SPACE_DEFAULT,
        ),
        Block::Paragraph("Not modelled, or short of the equations:".into()),
        Block::List(MISSING.map(String::from).to_vec()),
    ];
    Section::new("deviations", "Deviations from the paper, and limits", blocks)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> impl Iterator<Item = &'static Deviation> {
        COMMON.iter().chain(&LINE).chain(&SPACE).chain(&SPACE_DEFAULT)
    }

    /// Words of a text, without what encloses them.
    fn words(text: &str) -> impl Iterator<Item = &str> {
        text.split(|c: char| !c.is_ascii_alphanumeric() && c != '-').filter(|word| !word.is_empty())
    }

    /// Decisions, gaps and cases that are named exist, and every deviation names where to look.
    #[test]
    fn what_is_named_is_there() {
        let references = concat!(env!("CARGO_MANIFEST_DIR"), "/../references");
        let files = std::fs::read_dir(format!("{references}/decisions")).expect("the decisions");
        let decisions: Vec<String> =
            files.map(|e| e.expect("a file").file_name().to_string_lossy()[..4].into()).collect();
        let gaps = std::fs::read_to_string(format!("{references}/gaps.toml")).expect("the gaps");
        for [what, why, place] in all() {
            let mut places = 0;
            for word in words(place) {
                let number = word.len() == 4 && word.starts_with('0');
                assert!(!number || decisions.iter().any(|d| d == word), "{what}: {word}");
                places += usize::from(number);
            }
            for name in place.split('`').skip(1).step_by(2) {
                let case = crate::cases::find(name).is_some();
                let variant = crate::cases::ALL.iter().any(|c| c.variants().contains(&name));
                assert!(case || variant || name.starts_with("whipple "), "{what}: {name}");
                places += 1;
            }
            assert!(places > 0, "{what}: {place}");
            for gap in words(why).filter(|w| w.starts_with('G') && w[1..].parse::<u8>().is_ok()) {
                assert!(gaps.contains(&format!("id = \"{gap}\"")), "{what}: {gap}");
            }
        }
    }

    /// Every decision about the method in space is a deviation, and is named.
    #[test]
    fn no_decision_about_the_method_is_left_out() {
        let named: String = all().map(|row| row[2]).collect();
        for decision in (1..=7).chain(12..=25) {
            assert!(named.contains(&format!("{decision:04}")), "{decision}");
        }
    }
}
