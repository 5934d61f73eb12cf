//! Which instructions carry out eight lanes: chosen at run time, the same bits whichever it is.
//!
//! `POLHODE_SIMD=portable|avx2|avx512` forces a path; without it the widest that the processor has is taken. Every
//! operation of a pack is IEEE-exact or a call of the same scalar function, so the choice changes time and nothing else;
//! the tests compare the bits of all paths that the machine has.

#![expect(unsafe_code, reason = "functions compiled for instructions that the processor was asked about")]

#[cfg(target_arch = "x86_64")]
use super::avx512::Avx512;
#[cfg(target_arch = "x86_64")]
use super::portable::Portable;
use crate::numerics::pack::Pack;
use std::cell::Cell;
use std::sync::OnceLock;

/// The environment variable that forces a path.
pub const VARIABLE: &str = "POLHODE_SIMD";

/// A set of instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Instructions {
    /// What every processor of the platform has: one at a time. (Eight lanes of two in a register gain up to a factor of two
    /// there, but cost every build a minute.)
    Portable,
    /// AVX2, as the compiler uses it for eight lanes.
    Avx2,
    /// AVX-512 (F, DQ, VL, BW, CD), eight lanes in a register.
    Avx512,
}

impl Instructions {
    /// All, the narrowest first.
    pub const ALL: [Self; 3] = [Self::Portable, Self::Avx2, Self::Avx512];

    /// The name in `POLHODE_SIMD`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// Whether this processor has them.
    pub fn available(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        {
            match self {
                Self::Portable => true,
                Self::Avx2 => is_x86_feature_detected!("avx2"),
                Self::Avx512 => {
                    is_x86_feature_detected!("avx512f")
                        && is_x86_feature_detected!("avx512dq")
                        && is_x86_feature_detected!("avx512vl")
                        && is_x86_feature_detected!("avx512bw")
                        && is_x86_feature_detected!("avx512cd")
                }
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            self == Self::Portable
        }
    }

    /// The widest that this processor has.
    pub fn widest() -> Self {
        Self::ALL.into_iter().rev().find(|instructions| instructions.available()).unwrap_or(Self::Portable)
    }
}

/// What `POLHODE_SIMD` may not be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SimdError {
    /// A name that is none.
    #[error("{VARIABLE} = {found:?} is not accepted: portable, avx2 or avx512 (unset: the widest that there is)")]
    Unknown {
        /// What was found.
        found: String,
    },
    /// Instructions that this processor lacks.
    #[error("{VARIABLE} = {asked}: this processor has no such instructions; the widest that it has is {widest}")]
    Missing {
        /// What was asked for.
        asked: &'static str,
        /// What there is.
        widest: &'static str,
    },
}

/// The path that the environment asks for, or the widest.
///
/// # Errors
/// [`SimdError`]: a value of `POLHODE_SIMD` that can't be followed.
pub fn from_environment() -> Result<Instructions, SimdError> {
    let Some(found) = std::env::var_os(VARIABLE).filter(|value| !value.is_empty()) else {
        return Ok(Instructions::widest());
    };
    let found = found.to_string_lossy().into_owned();
    let asked = Instructions::ALL.into_iter().find(|instructions| instructions.name() == found);
    let asked = asked.ok_or(SimdError::Unknown { found })?;
    if asked.available() {
        Ok(asked)
    } else {
        Err(SimdError::Missing { asked: asked.name(), widest: Instructions::widest().name() })
    }
}

/// The path that [`dispatch`] takes: that of [`with_instructions`] inside it, else that of the environment as it was first
/// asked; where that can't be followed (the command refuses it at its start), the widest.
pub fn chosen() -> Instructions {
    static CHOSEN: OnceLock<Instructions> = OnceLock::new();
    FORCED
        .get()
        .unwrap_or_else(|| *CHOSEN.get_or_init(|| from_environment().unwrap_or_else(|_| Instructions::widest())))
}

thread_local! {
    static FORCED: Cell<Option<Instructions>> = const { Cell::new(None) };
}

/// Runs a function whose lanes, on this thread, are carried out by these instructions: for comparing paths.
pub fn with_instructions<T>(instructions: Instructions, function: impl FnOnce() -> T) -> T {
    let before = FORCED.replace(Some(instructions));
    let result = function();
    FORCED.set(before);
    result
}

/// Work that is written over packs.
pub trait LaneWork {
    /// What it returns.
    type Output;
    /// Does it with packs of `f64`, eight or one. To be marked `#[inline(always)]`, as everything heavy below it: what is not
    /// inlined is compiled without the wider instructions.
    fn run<P: Pack<Scalar = f64>>(self) -> Self::Output;
}

/// Does work with the instructions [`chosen`].
pub fn dispatch<W: LaneWork>(work: W) -> W::Output {
    dispatch_with(chosen(), work)
}

/// Does work with given instructions; the widest narrower ones that there are, if the processor lacks them.
pub fn dispatch_with<W: LaneWork>(instructions: Instructions, work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    {
        if instructions == Instructions::Avx512 && instructions.available() {
            // SAFETY: the processor was asked.
            return unsafe { with_avx512(work) };
        }
        if instructions >= Instructions::Avx2 && Instructions::Avx2.available() {
            // SAFETY: the processor was asked.
            return unsafe { with_avx2(work) };
        }
    }
    work.run::<f64>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw,avx512cd,avx2")]
fn with_avx512<W: LaneWork>(work: W) -> W::Output {
    work.run::<Avx512>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2<W: LaneWork>(work: W) -> W::Output {
    work.run::<Portable>()
}
