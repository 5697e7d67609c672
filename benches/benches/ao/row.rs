//! What is measured.

/// A kind of work. Its name in tables is that of the variant, in small letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Row {
    /// A picture: primary rays, and short shadow rays from what they meet.
    Frame,
    /// The closest hits of a camera's rays.
    Primary,
    /// Whether shadow rays meet something within a tenth of the scene's diagonal.
    AoShort,
    /// Whether they meet anything.
    AoUnbounded,
    /// The short ones, asked one after another instead of eight at once.
    AoShortUnbatched,
    /// The closest hits of the rays that shadow rays without an end are.
    Bounce,
    /// One ray after another, asked on the host.
    SingleClosest,
    /// Making the shadow rays, which kernels do while they ask.
    Generation,
    /// Making the camera's rays.
    PrimaryGeneration,
    /// From the hit of a primary ray to its shadow rays, which a frame makes while it asks.
    FrameGeneration,
    /// Building trees.
    Build,
}

impl Row {
    /// Those with figures of several systems.
    pub(crate) const COMPARED: [Self; 8] = [
        Self::Frame,
        Self::Primary,
        Self::AoShort,
        Self::AoUnbounded,
        Self::AoShortUnbatched,
        Self::Bounce,
        Self::SingleClosest,
        Self::Build,
    ];
    /// What others are charged with.
    pub(crate) const CHARGES: [Self; 3] =
        [Self::Generation, Self::PrimaryGeneration, Self::FrameGeneration];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Frame => "frame",
            Self::Primary => "primary",
            Self::AoShort => "ao_short",
            Self::AoUnbounded => "ao_unbounded",
            Self::AoShortUnbatched => "ao_short_unbatched",
            Self::Bounce => "bounce",
            Self::SingleClosest => "single_closest",
            Self::Generation => "generation",
            Self::PrimaryGeneration => "generation_primary",
            Self::FrameGeneration => "generation_frame",
            Self::Build => "build",
        }
    }

    pub(crate) fn from_name(name: &str) -> Result<Self, String> {
        let names = Self::COMPARED.map(Self::name).join(", ");
        let row = Self::COMPARED.into_iter().find(|row| row.name() == name);
        row.ok_or_else(|| format!("rows are {names}"))
    }

    /// What systems that are given their rays are charged with: the library makes them in the time
    /// that is measured.
    pub(crate) const fn charge(self) -> Option<Self> {
        match self {
            Self::Primary => Some(Self::PrimaryGeneration),
            Self::AoShort | Self::AoUnbounded | Self::Bounce => Some(Self::Generation),
            _ => None,
        }
    }

    /// The row whose rays are the same, where the other systems are.
    pub(crate) const fn rival(self) -> Self {
        match self {
            Self::AoShortUnbatched => Self::AoShort,
            row => row,
        }
    }

    /// Whether this row must be run for the figures of `wanted`.
    pub(crate) fn serves(self, wanted: Self) -> bool {
        let of_frame =
            matches!(self, Self::Primary | Self::AoShort) || Self::CHARGES.contains(&self);
        self == wanted
            || self == wanted.rival()
            || wanted.rival().charge() == Some(self)
            || wanted == Self::Frame && of_frame
    }
}
