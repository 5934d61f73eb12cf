//! The machine that a measurement was made on, in words: part of a measurement's parameters, so that one store serves many machines.

/// Processor, threads, system: `AMD EPYC 9R14, 2 threads, linux x86_64`.
///
/// The processor's name is what Linux tells; elsewhere its architecture must do.
pub fn describe() -> String {
    let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = told.lines().find(|line| line.starts_with("model name"));
    let name = line.and_then(|line| line.split_once(':')).map_or("unnamed processor", |(_, name)| name.trim());
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{name}, {threads} threads, {} {}", std::env::consts::OS, std::env::consts::ARCH)
}

#[cfg(test)]
mod tests {
    /// Twice the same: it is part of a key. And the words are there.
    #[test]
    fn a_machine_describes_itself_always_the_same() {
        let words = super::describe();
        assert_eq!(words, super::describe());
        assert!(words.contains(" threads, ") && words.ends_with(std::env::consts::ARCH) && words.lines().count() == 1);
    }
}
