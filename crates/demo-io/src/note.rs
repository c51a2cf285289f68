use std::fmt;

/// Something noticed while reading that did not prevent it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// What kind of thing.
    pub kind: NoteKind,
    /// What, where and what next, in one sentence.
    pub text: String,
}

/// Kinds of [`Note`]s.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum NoteKind {
    /// A stamp occurs twice; the first sample was kept.
    DuplicateStamp,
    /// A step over three times the usual time.
    Gap,
    /// Time steps differ.
    Uneven,
    /// An episode too short to learn from was left out.
    TooShort,
    /// An episode begins or ends standing still.
    StandsStill,
    /// One step is far longer than all around it.
    Jump,
    /// An angle that jumps by a whole turn.
    LooksWrapped,
    /// Angles that seem to be degrees.
    LooksLikeDegrees,
    /// Velocities that do not belong to the steps.
    VelocityMismatch,
    /// The same episode twice; the second was left out.
    DuplicateEpisode,
    /// Positions are whole numbers.
    Integers,
    /// Positions have few digits.
    CoarseFloats,
    /// Decimal commas were read.
    DecimalComma,
    /// A column that was not used.
    Ignored,
    /// The file ends in the middle; what is whole was read.
    Truncated,
}

impl NoteKind {
    /// The variant's name, for machines and for searching.
    pub fn code(self) -> &'static str {
        match self {
            NoteKind::DuplicateStamp => "DuplicateStamp",
            NoteKind::Gap => "Gap",
            NoteKind::Uneven => "Uneven",
            NoteKind::TooShort => "TooShort",
            NoteKind::StandsStill => "StandsStill",
            NoteKind::Jump => "Jump",
            NoteKind::LooksWrapped => "LooksWrapped",
            NoteKind::LooksLikeDegrees => "LooksLikeDegrees",
            NoteKind::VelocityMismatch => "VelocityMismatch",
            NoteKind::DuplicateEpisode => "DuplicateEpisode",
            NoteKind::Integers => "Integers",
            NoteKind::CoarseFloats => "CoarseFloats",
            NoteKind::DecimalComma => "DecimalComma",
            NoteKind::Ignored => "Ignored",
            NoteKind::Truncated => "Truncated",
        }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
