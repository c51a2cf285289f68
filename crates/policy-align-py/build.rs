//! On macOS, adds the arguments for linking an extension module without a Python library; elsewhere
//! it has no effect.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
