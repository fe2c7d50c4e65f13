//! The phases of a step, for those who measure what each takes. The solver reads no clock: it tells
//! what it turns to, and in [`Simulation::step`](super::Simulation::step) nobody listens.

/// What a step is at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Phase {
    /// Forces of the elements: the first pass through memory.
    Elements,
    /// Forces of contacts between loose particles, and in a single pass their work.
    Contacts,
    /// Work of contacts over the mean velocities: the second pass of the compatible integrator.
    Work,
    /// Forces and work of the springs between surfaces.
    Springs,
    /// Kick, work of the elements, response and drift: the second pass through memory.
    Motion,
    /// Places of those that may touch, and the list of pairs where it is renewed.
    List,
    /// Density by a kernel, where a method has one, and the response to it.
    Kernel,
    /// Length of the step, walls, waking, burial, checks.
    Control,
}

impl Phase {
    /// All phases.
    pub const ALL: [Self; 8] = [
        Self::Elements,
        Self::Contacts,
        Self::Work,
        Self::Springs,
        Self::Motion,
        Self::List,
        Self::Kernel,
        Self::Control,
    ];

    /// Name for tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Elements => "elements",
            Self::Contacts => "contacts",
            Self::Work => "work",
            Self::Springs => "springs",
            Self::Motion => "motion",
            Self::List => "list",
            Self::Kernel => "kernel",
            Self::Control => "control",
        }
    }
}
