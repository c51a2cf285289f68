#[test]
fn t() {
    let r = demo_io::read_all(&["/tmp/ctx/goals.csv".into()], &demo_io::ReadOptions::default(), &mut |_| ()).unwrap();
    let p = policy_align::prepare(&r, &policy_align::PrepareOptions::default()).unwrap();
    let never = std::sync::atomic::AtomicBool::new(false);
    let m = policy_align::fit(&p, &policy_align::FitOptions::default(), &mut policy_align::Progress { cancelled: &never, report: &mut |_| () }).unwrap();
    policy_align::estimate_constraints(&m, &p, None).unwrap();
}
