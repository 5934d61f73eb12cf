//! `polhode log`: past runs that did something, the newest first.

use crate::cli::arguments::LogArguments;
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::session::{Refused, STORE_FORMAT};
use crate::cli::workspace::Workspace;
use crate::pipeline::runs::PastRun;
use crate::pipeline::store::Store;
use serde_json::json;
use std::fmt::Write as _;

/// The version of the JSON that `log` prints.
const SCHEMA: u32 = 1;

/// Nodes of a run that are named, slowest first.
const NAMED: usize = 3;

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &LogArguments) -> Result<Exit, ConsoleError> {
    let workspace = match Workspace::find(&arguments.place) {
        Ok(workspace) => workspace,
        Err(error) => return Ok(Refused::from(error).tell()),
    };
    let runs = Store::at(workspace.store.join(STORE_FORMAT)).runs(arguments.last);
    if arguments.json {
        let value = json!({ "schema": SCHEMA, "runs": runs });
        console::data(&format!("{value:#}\n"))?;
    } else {
        console::data(&runs.iter().map(text).collect::<String>())?;
        if runs.is_empty() {
            console::message("no run has changed anything in this store yet");
        }
    }
    Ok(Exit::Success)
}

fn text(run: &PastRun) -> String {
    let targets = if run.targets.is_empty() { "everything".to_owned() } else { run.targets.join(" ") };
    let mut text = format!("{}  {:.2} s  {targets}\n", utc(run.began), run.seconds);
    let mut counts = vec![format!("{} ran", run.ran.len()), format!("{} up to date", run.cached)];
    if !run.failed.is_empty() {
        counts.push(format!("{} failed", run.failed.len()));
    }
    counts.push(format!("{} outputs written", run.written.len()));
    // Writing to a String does not fail.
    let _ = writeln!(text, "    {}", counts.join(", "));
    let mut slowest: Vec<_> = run.ran.iter().collect();
    slowest.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
    for node in slowest.iter().take(NAMED) {
        let _ = writeln!(text, "    {:>8.2} s  {}", node.seconds, node.address);
    }
    if slowest.len() > NAMED {
        let rest: f64 = slowest[NAMED..].iter().map(|node| node.seconds).sum();
        let _ = writeln!(text, "    {rest:>8.2} s  {} more", slowest.len() - NAMED);
    }
    for (address, why) in &run.failed {
        let _ = writeln!(text, "    failed {address}: {why}");
    }
    for damage in &run.damage {
        let _ = writeln!(text, "    repaired: {damage}");
    }
    text
}

/// Seconds since 1970 as a date and time of day in UTC, by the proleptic Gregorian calendar (years of 400 make eras
/// of 146097 days; a year is counted from March, so that the leap day comes last).
fn utc(seconds: f64) -> String {
    let whole = seconds.max(0.0) as u64;
    let (days, second) = (whole / 86_400, whole % 86_400);
    let days = days + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = era * 400 + year_of_era + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02} {:02}:{:02}:{:02} UTC", second / 3_600, second / 60 % 60, second % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: `date -u -d @…`.
    #[test]
    fn dates() {
        assert_eq!(utc(0.0), "1970-01-01 00:00:00 UTC");
        assert_eq!(utc(951_782_400.5), "2000-02-29 00:00:00 UTC");
        assert_eq!(utc(1_709_251_199.0), "2024-02-29 23:59:59 UTC");
        assert_eq!(utc(4_107_542_400.0), "2100-03-01 00:00:00 UTC");
        assert_eq!(utc(1_795_357_903.0), "2026-11-22 14:31:43 UTC");
    }
}
