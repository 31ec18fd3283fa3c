//! Compiles the reference (`ceres/`) and links it with Ceres.

use std::path::{Path, PathBuf};
use std::process::Command;

const SOURCES: [&str; 7] =
    ["reference.cpp", "reference.h", "quadrature.hpp", "element.hpp", "start.hpp", "model.hpp", "newton.hpp"];

fn main() {
    for source in SOURCES {
        println!("cargo:rerun-if-changed=ceres/{source}");
    }
    println!("cargo:rerun-if-env-changed=CERES_INCLUDE_DIR");
    println!("cargo:rerun-if-env-changed=CERES_LIB_DIR");
    println!("cargo:rerun-if-env-changed=EIGEN_INCLUDE_DIR");

    let ceres =
        included("CERES_INCLUDE_DIR", "ceres", "ceres/ceres.h", &["/usr/include", "/usr/local/include"]);
    let eigen = included(
        "EIGEN_INCLUDE_DIR",
        "eigen3",
        "Eigen/Dense",
        &["/usr/include/eigen3", "/usr/local/include/eigen3"],
    );
    let (Some(ceres), Some(eigen)) = (ceres, eigen) else {
        eprintln!(
            "The tests compare minvar with Ceres, which was not found: install libceres-dev, \
             or set CERES_INCLUDE_DIR, EIGEN_INCLUDE_DIR and CERES_LIB_DIR."
        );
        std::process::exit(1);
    };

    let mut build = cc::Build::new();
    build
        .cpp(true)
        .file("ceres/reference.cpp")
        .std("c++17")
        .warnings(true)
        .extra_warnings(true)
        // Autodiff without optimisation takes minutes; the profile does not decide.
        .opt_level(2)
        .debug(false)
        .define("NDEBUG", None)
        .flag("-ffp-contract=off");
    for directory in [&ceres, &eigen] {
        // A system header's warnings are not ours; /usr/include is searched anyway, and naming it reorders the search.
        if directory != Path::new("/usr/include") {
            build.flag("-isystem").flag(directory);
        }
    }
    build.compile("minvar_reference");

    if let Ok(directory) = std::env::var("CERES_LIB_DIR") {
        println!("cargo:rustc-link-search=native={directory}");
    }
    println!("cargo:rustc-link-lib=ceres");
    println!("cargo:rustc-link-lib=glog");
}

/// The directory that holds `header`: named by the variable, by pkg-config, or one of the usual ones.
fn included(variable: &str, package: &str, header: &str, usual: &[&str]) -> Option<PathBuf> {
    let mut places: Vec<PathBuf> = std::env::var(variable).into_iter().map(PathBuf::from).collect();
    if let Ok(output) = Command::new("pkg-config").args(["--cflags-only-I", package]).output() {
        let flags = String::from_utf8_lossy(&output.stdout).into_owned();
        places.extend(flags.split_whitespace().filter_map(|f| f.strip_prefix("-I")).map(PathBuf::from));
    }
    places.extend(usual.iter().map(PathBuf::from));
    places.into_iter().find(|p| p.join(header).is_file())
}
