//! On macOS an extension module is linked before there is a Python; elsewhere this says nothing.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
