//! The command line: verbs, options and their help.

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Regenerates the article on the Euler-Poinsot rigid body motion, and answers for single points.
#[derive(Debug, Parser)]
#[command(
    name = "polhode",
    version,
    disable_help_subcommand = true,
    before_help = "Examples:
  polhode figures                       regenerate the whole article into figures/
  polhode figures fig7                  only Figure 7
  polhode why figures/fig7.svg          why it will (not) be computed again
  polhode check                         goldens, references and claims: the verdict table
  polhode point spin k=0.8 p_theta=1    one first conjugate point
  polhode point serret-andoyer A=1.5 B=2 C=2.8 phi0=0 delta=1e-3 branch=ascending
  polhode accuracy fig7                 what accuracy costs in time, and how far each level is off
  polhode show fig7/conjugate-locus/k=0.8 --csv
  polhode verify --sample 10            re-hash the store and compute ten nodes again
  polhode init my-paper                 a folder to work in, outside the repository"
)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub verb: Verb,
}

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Compute what is stale and write figures, data and values: the main job
    Figures(FiguresArguments),
    /// Run what is stale, then compare with goldens and references and judge the article's claims
    Check(CheckArguments),
    /// Say why a target will (not) be computed again: the changed leaf, old → new, and what follows
    Why(WhyArguments),
    /// List the experiments, their nodes, outputs and work
    List(ListArguments),
    /// Print the graph of nodes
    Graph(GraphArguments),
    /// Print a computed table, with units and meanings
    Show(ShowArguments),
    /// Compute the first conjugate point of one extremal, or of a table of them
    Point(PointArguments),
    /// Measure what accuracy costs in time on this machine, and how far each level is from the reference
    Accuracy(AccuracyArguments),
    /// Write a new experiment, ready to run: a module and its config, or the config of a scene
    New(NewArguments),
    /// Make a folder to work in: the article's configs, ready to edit and run
    Init(InitArguments),
    /// Re-hash the whole store, and compute a sample of it again
    Verify(VerifyArguments),
    /// Drop from the store what the last runs don't need
    Gc(GcArguments),
    /// Past runs: when, what ran, how long it took
    Log(LogArguments),
    /// Print the JSON schema of the configs, for editors
    Schema(SchemaArguments),
    /// Print the completions of a shell
    Completions(CompletionsArguments),
}

/// Where things lie, and how to run: the options that verbs share.
#[derive(Args, Clone, Debug, Default)]
pub struct PlaceArguments {
    /// Folder of the experiment configs [default: experiments/ of the nearest ancestor that has one]
    #[arg(long, value_name = "DIR")]
    pub experiments: Option<PathBuf>,
    /// Folder of the outputs [default: figures/ beside experiments/]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Folder of the store [default: .polhode/ beside experiments/]
    #[arg(long, value_name = "DIR")]
    pub store: Option<PathBuf>,
    /// Accuracy in place of the configs': draft (1e-4), article (1e-14), reference (double-double) or a relative error from
    /// 1e-28 to 0.1; outputs of another level than article go to OUT/LEVEL/
    #[arg(long, value_name = "LEVEL")]
    pub accuracy: Option<String>,
}

/// How to run what is stale.
#[derive(Args, Clone, Debug, Default)]
pub struct RunArguments {
    /// Where things lie.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// Nodes in flight at once [default: the number of cores]
    #[arg(long, short, value_name = "N")]
    pub jobs: Option<std::num::NonZeroUsize>,
    /// Plain output: no progress line even on a terminal
    #[arg(long)]
    pub no_progress: bool,
    /// Machine-readable output on stdout
    #[arg(long)]
    pub json: bool,
}

/// Options of `figures`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode figures                 everything
  polhode figures fig7 fig8       two experiments
  polhode figures --dry-run       what would run, and why; nothing is written
  polhode figures fig7 --watch    draw again whenever a config is saved; Ctrl-C ends
  polhode figures cost_of_effects --measure          times on this machine, into figures/measured/
  polhode figures --out /tmp/f --store /tmp/s --jobs 1")]
pub struct FiguresArguments {
    /// Experiments (fig7), outputs (figures/fig7.svg) or nodes (fig7/conjugate-locus/k=0.8); all where none is given
    #[arg(value_name = "TARGET")]
    pub targets: Vec<String>,
    /// Where and how.
    #[command(flatten)]
    pub run: RunArguments,
    /// Measure times too, into OUT/measured/; what was measured on this machine stands until --force measures again
    #[arg(long)]
    pub measure: bool,
    /// Compute again even what is up to date
    #[arg(long)]
    pub force: bool,
    /// Stop at the first node that fails
    #[arg(long)]
    pub fail_fast: bool,
    /// Say what would run and why; write nothing; exit code 6 where an output would change
    #[arg(long)]
    pub dry_run: bool,
    /// Run again whenever a config is saved, until Ctrl-C
    #[arg(long, conflicts_with_all = ["dry_run", "force", "json", "measure"])]
    pub watch: bool,
}

/// Options of `check`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode check                   the verdict table
  polhode check fig4              of one experiment
  polhode check --strict --json   as continuous integration asks it")]
pub struct CheckArguments {
    /// Experiments; all where none is given
    #[arg(value_name = "TARGET")]
    pub targets: Vec<String>,
    /// Where and how.
    #[command(flatten)]
    pub run: RunArguments,
    /// A golden that can't be compared (edited config, no golden yet) counts as different
    #[arg(long)]
    pub strict: bool,
}

/// Options of `why`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode why fig7
  polhode why figures/fig7.svg
  polhode why fig7/conjugate-locus/k=0.8 --json")]
pub struct WhyArguments {
    /// An experiment, an output or a node
    #[arg(value_name = "TARGET")]
    pub target: String,
    /// Where things lie.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// Machine-readable output on stdout
    #[arg(long)]
    pub json: bool,
}

/// Options of `list`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode list
  polhode list fig7 --json")]
pub struct ListArguments {
    /// Experiments; all where none is given
    #[arg(value_name = "TARGET")]
    pub targets: Vec<String>,
    /// Where things lie.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// Machine-readable output on stdout
    #[arg(long)]
    pub json: bool,
}

/// A way to write the graph.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum GraphForm {
    /// Indented text
    #[default]
    Text,
    /// A picture
    Svg,
    /// Graphviz
    Dot,
    /// Mermaid
    Mermaid,
    /// JSON
    Json,
}

/// Options of `graph`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode graph fig7
  polhode graph --form svg > graph.svg      a picture; nodes that differ in axis values only are one box
  polhode graph fig7 --form dot | dot -Tpdf > fig7.pdf")]
pub struct GraphArguments {
    /// Experiments; all where none is given
    #[arg(value_name = "TARGET")]
    pub targets: Vec<String>,
    /// Where things lie.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// The form
    #[arg(long, visible_alias = "format", value_enum, default_value_t)]
    pub form: GraphForm,
    /// The same as --form json
    #[arg(long)]
    pub json: bool,
}

/// Options of `show`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode show fig7/conjugate-locus/k=0.8
  polhode show fig7/conjugate-locus/k=0.8 --csv > locus.csv
  polhode show figures/data/fig7/conjugate-locus-k=0.8.parquet")]
pub struct ShowArguments {
    /// A node's address, with `:NAME` where it has more than one table, or a Parquet file
    #[arg(value_name = "TABLE")]
    pub table: String,
    /// Where things lie.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// All rows as CSV, floats in full
    #[arg(long)]
    pub csv: bool,
    /// Rows at most, as text
    #[arg(long, value_name = "N", default_value_t = 40)]
    pub rows: usize,
}

/// Options of `point`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode point spin k=0.8 p_theta=1
  polhode point serret-andoyer A=1.5 B=2 C=2.8 phi0=0 delta=1e-3 branch=ascending
  polhode point serret-andoyer A=1.5 B=2 C=2.8 y0=0.5 p_x=1.1 p_y=0.3 --json
  polhode point rotation-group A=1.5 B=2 C=2.8 H1=-1 H2=-0.3 H3=0.3
  polhode point rotation-group A=1.5 B=2 C=2.8 Phi2=2.8506 Phi3=-0.32175 p1=0 p2=0 p3=0.3155946
  polhode point spin k=1.2 p_theta=1e-3 --accuracy reference          in double-double arithmetic, rounded
  polhode point spin k=0.8 --input starts.csv --output points.csv     a table of starts, columns named as the keys")]
pub struct PointArguments {
    /// serret-andoyer, spin or rotation-group
    #[arg(value_name = "METRIC")]
    pub metric: String,
    /// The metric's parameters and the start, as key=value; with --input, values for all rows
    #[arg(value_name = "KEY=VALUE")]
    pub values: Vec<String>,
    /// A table of starts: CSV or Parquet, by the file's ending
    #[arg(long, value_name = "FILE", requires = "output")]
    pub input: Option<PathBuf>,
    /// Where the table of points goes: CSV or Parquet, by the file's ending
    #[arg(long, value_name = "FILE", requires = "input")]
    pub output: Option<PathBuf>,
    /// Rows computed at once [default: the number of cores]
    #[arg(long, short, value_name = "N")]
    pub jobs: Option<std::num::NonZeroUsize>,
    /// draft, article, reference (double-double arithmetic, rounded) or a relative error from 1e-28 to 0.1
    #[arg(long, value_name = "LEVEL", default_value = "article")]
    pub accuracy: String,
    /// Machine-readable output on stdout
    #[arg(long)]
    pub json: bool,
    /// Plain output: no progress line even on a terminal
    #[arg(long)]
    pub no_progress: bool,
}

/// Options of `accuracy`.
#[derive(Args, Debug, Default)]
#[command(before_help = "Examples:
  polhode accuracy fig7                              draft, 1e-6 … 1e-12, article, reference: time, work, how far off
  polhode accuracy                                   the whole article; takes some minutes
  polhode accuracy fig3 --levels draft,article       only these, beside the reference
  polhode accuracy fig7 --json

Each level is computed from nothing in a store of its own, one after another; figures and store stay as they are. The plot goes to
OUT/measured/accuracy-TARGET.svg.")]
pub struct AccuracyArguments {
    /// An experiment, an output or a node; the whole article where none is given
    #[arg(value_name = "TARGET")]
    pub target: Option<String>,
    /// The levels beside the reference [default: draft,1e-6,1e-8,1e-10,1e-12,article]
    #[arg(long, value_name = "LEVEL,…", value_delimiter = ',')]
    pub levels: Vec<String>,
    /// Folder of the experiment configs [default: experiments/ of the nearest ancestor that has one]
    #[arg(long, value_name = "DIR")]
    pub experiments: Option<PathBuf>,
    /// Folder of the outputs, whose measured/ takes the plot [default: figures/ beside experiments/]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Machine-readable output on stdout
    #[arg(long)]
    pub json: bool,
    /// No progress on stderr
    #[arg(long)]
    pub no_progress: bool,
}

/// Options of `new`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode new fig10                        src/experiments/fig10.rs, experiments/fig10.toml and the word in mod.rs
  polhode new --scene spins                experiments/spins.toml: any effects of a metric, no Rust, in any folder
  polhode new --scene body --metric serret-andoyer
  polhode new --scene tops --metric rotation-group")]
pub struct NewArguments {
    /// The new experiment's id: lower-case letters, digits, underscores
    #[arg(value_name = "ID")]
    pub id: String,
    /// Write the config of a scene instead: a metric, starts, effects; it needs no module
    #[arg(long)]
    pub scene: bool,
    /// The metric of the scene
    #[arg(long, value_name = "METRIC", requires = "scene", default_value = SCENES[0].0,
          value_parser = clap::builder::PossibleValuesParser::new(SCENES.map(|(metric, _)| metric)))]
    pub metric: String,
    /// Folder of the experiment configs [default: experiments/ of the nearest ancestor that has one]
    #[arg(long, value_name = "DIR")]
    pub experiments: Option<PathBuf>,
}

/// The configs that scenes begin with, by metric; the first is the default.
pub const SCENES: [(&str, &str); 3] = [
    ("spin", include_str!("scenes/spin.toml")),
    ("serret-andoyer", include_str!("scenes/serret-andoyer.toml")),
    ("rotation-group", include_str!("scenes/rotation-group.toml")),
];

/// Options of `init`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode init my-paper && cd my-paper && polhode figures")]
pub struct InitArguments {
    /// The folder: made where it is missing; files in it are never written over
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

/// Options of `verify`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode verify                  re-hash the store, compute 8 stored nodes again, compare bits
  polhode verify --sample 0       re-hash only
  polhode verify --all --json     every stored node
  polhode verify fig7 --seed 2    another sample, of one experiment's nodes

Exit code: 1 where a node comes out otherwise than it is stored (a defect), 7 where the store is damaged
(the next run that needs the damaged part repairs it).")]
pub struct VerifyArguments {
    /// Experiments, outputs or nodes that the sample is taken from; all where none is given
    #[arg(value_name = "TARGET")]
    pub targets: Vec<String>,
    /// Where things lie.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// Stored nodes to compute again
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub sample: usize,
    /// Compute every stored node again
    #[arg(long, conflicts_with = "sample")]
    pub all: bool,
    /// Another number takes another sample
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    pub seed: u64,
    /// Threads [default: the number of cores]
    #[arg(long, short, value_name = "N")]
    pub jobs: Option<std::num::NonZeroUsize>,
    /// Plain output: no progress line even on a terminal
    #[arg(long)]
    pub no_progress: bool,
    /// Machine-readable output on stdout
    #[arg(long)]
    pub json: bool,
}

/// Options of `gc`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode gc --dry-run    what would go
  polhode gc              keep what the present configs and each output folder's last run need
  polhode gc --keep 5     also what the four runs before the last had left")]
pub struct GcArguments {
    /// Where things lie.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// Keep what this many last runs left
    #[arg(long, value_name = "RUNS", default_value = "1")]
    pub keep: std::num::NonZeroUsize,
    /// Forget what was shown in other output folders and at other accuracies
    #[arg(long)]
    pub here: bool,
    /// Say what would go; drop nothing
    #[arg(long)]
    pub dry_run: bool,
    /// Machine-readable output on stdout
    #[arg(long)]
    pub json: bool,
}

/// Options of `log`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode log
  polhode log --last 3 --json")]
pub struct LogArguments {
    /// Runs at most, the newest first
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub last: usize,
    /// Where things lie.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// Machine-readable output on stdout
    #[arg(long)]
    pub json: bool,
}

/// Options of `schema`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode schema > polhode.schema.json          the configs of all kinds
  polhode schema scene > scene.schema.json      of one kind: an editor's messages are more to the point

Editors with TOML support (taplo, Even Better TOML) check and complete a config that begins with
  #:schema ../scene.schema.json
What the schema can't say (A < B < C, say) is refused by polhode when it reads the config.")]
pub struct SchemaArguments {
    /// The kind of the configs: scene, fig7 …; all where none is given
    #[arg(value_name = "KIND", value_parser = clap::builder::PossibleValuesParser::new(
        crate::experiments::ALL.iter().map(|experiment| experiment.kind)))]
    pub kind: Option<String>,
}

/// Options of `completions`.
#[derive(Args, Debug)]
#[command(before_help = "Examples:
  polhode completions bash > ~/.local/share/bash-completion/completions/polhode
  polhode completions fish > ~/.config/fish/completions/polhode.fish")]
pub struct CompletionsArguments {
    /// The shell
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}
