use clap::Args;

use crate::cli::failure::Failure;
use crate::cli::session::{Output, Session};

/// Command a robot of ROS 2 by a policy (not in this build)
#[derive(Debug, Args)]
#[command(after_help = "\
Built with it, and without an installation of ROS 2:
  cargo install --path crates/policy-align --features ros2")]
pub(crate) struct Serve {
    /// Flags of a build that has the command
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    given: Vec<String>,
}

impl Serve {
    pub(crate) fn run(&self, _session: &Session) -> Result<Output, Failure> {
        let place = format!("policy-align serve {}", self.given.join(" "));
        let remedy = "cargo install --path crates/policy-align --features ros2";
        Err(Failure::usage("this program was built without ROS 2", place.trim_end(), remedy))
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, Command, FromArgMatches as _};

    use super::Serve;
    use crate::cli::failure::Exit;
    use crate::cli::session::Session;

    #[test]
    fn a_build_without_ros_2_names_the_feature() {
        let command = Serve::augment_args(Command::new("serve"));
        let given = command.try_get_matches_from("serve toy.json --ros2 --rate 20".split(' ')).unwrap();
        let failure = Serve::from_arg_matches(&given).unwrap().run(&Session::default()).unwrap_err();
        let lines = [
            "error: this program was built without ROS 2",
            "  in:  policy-align serve toy.json --ros2 --rate 20",
            "  try: cargo install --path crates/policy-align --features ros2",
        ];
        assert_eq!((failure.exit, failure.to_string().lines().collect::<Vec<_>>()), (Exit::Usage, lines.to_vec()));
    }
}
