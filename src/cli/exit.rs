//! Exit codes: the first that applies, in this order.

use std::process::ExitCode;

/// How a command ended. The order of the variants is the order of precedence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// The command line is wrong.
    Usage,
    /// A defect in polhode itself.
    Defect,
    /// The store can't be used.
    Store,
    /// An experiment config is wrong; nothing was written.
    Config,
    /// A node failed.
    NodeFailed,
    /// A verdict or an independent reference differs.
    VerdictDiffers,
    /// A golden differs, or (`--dry-run`, `why`) an output would change.
    GoldenDiffers,
    /// All is well.
    Success,
}

impl Exit {
    /// The code that the shell sees.
    pub fn code(self) -> u8 {
        match self {
            Self::Success => 0,
            Self::Defect => 1,
            Self::Usage => 2,
            Self::Config => 3,
            Self::NodeFailed => 4,
            Self::VerdictDiffers => 5,
            Self::GoldenDiffers => 6,
            Self::Store => 7,
        }
    }

    /// The one of two that takes precedence.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        self.min(other)
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit.code())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_that_applies_wins() {
        assert_eq!(Exit::Success.and(Exit::GoldenDiffers), Exit::GoldenDiffers);
        assert_eq!(Exit::GoldenDiffers.and(Exit::VerdictDiffers).code(), 5);
        assert_eq!(Exit::Config.and(Exit::Store).code(), 7);
        assert_eq!(Exit::Defect.and(Exit::Store).code(), 1);
        assert_eq!(Exit::Defect.and(Exit::Usage).code(), 2);
    }
}
