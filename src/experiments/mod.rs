//! The experiments, by name. Adding one costs its file, its config and one word here.

pub mod definition;
pub mod findings;
pub mod nodes;
#[cfg(test)]
pub mod preview;
pub mod scenes;
pub mod spin_branches;
#[cfg(test)]
pub mod template;
pub mod three_problems;

macro_rules! experiments {
    ($($name:ident)*) => {
        $(pub mod $name;)*
        /// All experiments, in the article's order; last the one that is none of its: a scene.
        pub const ALL: &[definition::Experiment] = &[$($name::EXPERIMENT),*];
    };
}

experiments! { fig1 fig2 theorem_3_9 remark_3_25 fig3 fig4 fig5 fig6 fig7 fig8 fig9 cost_of_effects accuracy hard_cases statements scene }
