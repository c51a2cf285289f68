use std::fs;

/// CPU time of all threads of this process so far; 0 if the system does not provide it.
pub fn cpu_seconds() -> f64 {
    let Ok(tasks) = fs::read_dir("/proc/self/task") else { return 0.0 };
    let schedules = tasks.flatten().filter_map(|task| fs::read_to_string(task.path().join("schedstat")).ok());
    schedules.filter_map(|line| line.split(' ').next()?.parse::<f64>().ok()).sum::<f64>() * 1e-9
}

/// Peak memory of this process so far, in megabytes; 0 if the system does not provide it.
pub fn peak_megabytes() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().split(' ').next()?.parse::<f64>().ok()).map_or(0.0, |kilobytes| kilobytes / 1024.0)
}
