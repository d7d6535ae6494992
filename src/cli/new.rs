//! `new`: a commented scene to start from.

use super::arguments::{NewArguments, SceneKind};
use super::execute::print_out;
use super::exit::{Exit, Failure};
use super::files::write_file;
use std::path::PathBuf;

pub(super) fn new(arguments: &NewArguments) -> Result<Exit, Failure> {
    let name = arguments.name.as_str();
    let plain = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    if name.is_empty() || name.starts_with('.') || !name.chars().all(plain) {
        return Err(Failure::Arguments(format!(
            "'{name}' cannot name a folder everywhere: write letters, digits, '-', '_' and '.'"
        )));
    }
    let path = PathBuf::from("analyses").join(name).join("scene.toml");
    if path.exists() {
        return Err(Failure::Arguments(format!(
            "{} is there already and is left as it is: choose another name, or edit it",
            path.display()
        )));
    }
    write_file(&path, &template(arguments.kind).replace("NAME", name))?;
    print_out(&format!(
        "Written to {}. A first look, in seconds:\n  remainder run analyses/{name} --quick\n",
        path.display()
    ));
    Ok(Exit::AsExpected)
}

fn template(kind: SceneKind) -> &'static str {
    match kind {
        SceneKind::MomentOrders => include_str!("scenes/moment-orders.toml"),
        SceneKind::OperatorOrders => include_str!("scenes/operator-orders.toml"),
        SceneKind::Heat => include_str!("scenes/heat.toml"),
        SceneKind::Stiff => include_str!("scenes/stiff.toml"),
        SceneKind::WorkPrecision => include_str!("scenes/work-precision.toml"),
        SceneKind::Extremes => include_str!("scenes/extremes.toml"),
        SceneKind::Basa => include_str!("scenes/basa.toml"),
        SceneKind::Chaussonnet => include_str!("scenes/chaussonnet.toml"),
    }
}
