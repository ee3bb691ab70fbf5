//! Faults of a Part 21 file.

/// Fault of a file, and its line.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}{fault}", line.map(|line| format!("line {line}: ")).unwrap_or_default())]
pub struct Part21Error {
    /// Line of the file, from 1; None if the fault is of the whole file.
    pub line: Option<usize>,
    /// Reason why the file cannot be read.
    pub fault: Part21Fault,
}

/// Reason why a file cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Part21Fault {
    /// A zipped or gzipped file.
    #[error("the file is compressed: unpack it first")]
    Compressed,
    /// A file in another format.
    #[error("the file does not begin with ISO-10303-21: export the part as STEP AP242 (Part 21, text)")]
    NotPart21,
    /// A section of Part 21 edition 3 that refers to other files.
    #[error("a section {0} is of Part 21 edition 3 and refers to other files: export one plain file")]
    Section(String),
    /// More bytes than an offset holds.
    #[error("the file has more than 4 GB: export the part alone")]
    TooLarge,
    /// An end in the middle of the text.
    #[error("the file ends here, before END-ISO-10303-21: it was cut off, copy or export it again")]
    CutOff,
    /// Text that is not an entity.
    #[error("expected {expected}, found `{found}`: the file is damaged, export it again")]
    Syntax {
        /// Text that the syntax needs.
        expected: &'static str,
        /// First characters of the text.
        found: String,
    },
    /// Two entities of one number.
    #[error("#{0} is defined twice: the file is damaged, export it again")]
    Twice(u64),
    /// Reference without an entity.
    #[error("#{from} refers to #{to}, which is not in the file: export it again")]
    Dangling {
        /// Entity that refers.
        from: u64,
        /// Number without an entity.
        to: u64,
    },
    /// Lists inside lists.
    #[error("#{0} has lists inside lists, more than {1} deep: the file is damaged, export it again")]
    Deep(u64, usize),
    /// A list of very many values.
    #[error("#{0} has more than {1} values: the file is damaged, export it again")]
    Long(u64, usize),
    /// Parts that contain themselves.
    #[error("assembly #{0} contains itself: the file is damaged, export it again")]
    Cyclic(u64),
    /// Relations that lead to far more entities than a part has.
    #[error("the relations of #{0} lead to more than {1} entities: the file is damaged, export it again")]
    Wide(u64, usize),
    /// An assembly with very many parts.
    #[error("the assembly has more than {0} placed parts: export a smaller assembly")]
    Parts(usize),
}
