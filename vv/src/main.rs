//! The program `whipple`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(whipple_vv::cli::main())
}
