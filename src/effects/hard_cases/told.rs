//! What `point` answers, as a case of a family holds it.

use super::family::Told;
use crate::contract::work::Work;
use crate::effects::point::{Answer, PointError};

/// No answer, with its reason in place of a route.
pub fn nothing(reason: String) -> (Told, String, Work) {
    (Told { value: f64::NAN, claimed: f64::NAN }, reason, Work::default())
}

/// One number of an answer with the error that it claims, its route and its work; [`nothing`] where there is no such number.
pub fn told(answer: Result<Answer, PointError>, index: usize) -> (Told, String, Work) {
    let answer = match answer {
        Ok(answer) => answer,
        Err(error) => return nothing(error.to_string()),
    };
    match (answer.numbers.get(index).copied().flatten(), answer.error) {
        (Some(value), Some(claimed)) => (Told { value, claimed }, answer.route, answer.work),
        _ => nothing(answer.reason.unwrap_or_default()),
    }
}
