use super::*;

fn columns(names: &[&str]) -> Vec<Column> {
    let content = |name: &str| if is_one_of(&ROW_NUMBERS, name) { Content::Counting } else { Content::Numbers };
    names.iter().map(|&name| Column { name: name.to_owned(), content: content(name) }).collect()
}

fn assigned(names: &[&str], options: &ReadOptions) -> Roles {
    assign(&columns(names), options, "here").unwrap()
}

fn by_name(names: &[&str]) -> Roles {
    assigned(names, &ReadOptions::default())
}

#[test]
fn usual_names_are_understood() {
    for (names, time, episode, state, velocity) in [
        (&["episode", "t", "x", "y", "vx", "vy"][..], Some(1), Some(0), &[2, 3][..], &[4, 5][..]),
        (&["", "Time", "X", "Y"], Some(1), None, &[2, 3], &[]),
        (&["t_ms", "q1", "q2", "dq1", "dq2"], Some(0), None, &[1, 2], &[3, 4]),
        (&["t_ms", "q1", "q2", "qd1", "qd2"], Some(0), None, &[1, 2], &[3, 4]),
        (&["time_micros", "q1", "q2", "qd1", "qd2"], Some(0), None, &[1, 2], &[3, 4]),
        (&["x0", "x1", "v0", "v1"], None, None, &[0, 1], &[2, 3]),
        (&["q_1", "v_1", "q_2", "v_2"], None, None, &[0, 2], &[1, 3]),
        (&["p[0]", "p[1]", "v[0]", "v[1]"], None, None, &[0, 1], &[2, 3]),
        (&["position[0]", "position[1]", "velocity[0]", "velocity[1]"], None, None, &[0, 1], &[2, 3]),
        (&["a_pos", "b_pos", "a_vel", "b_vel"], None, None, &[0, 1], &[2, 3]),
        (&["x", "x_dot", "y", "y_dot", "time [s]"], Some(4), None, &[0, 2], &[1, 3]),
        (&["joint1", "joint1.vel", "effort1", "reward"], None, None, &[0], &[1]),
        (&["x", "y", "vx", "vy", "Force_X", "force y", "wrench.z"], None, None, &[0, 1], &[2, 3]),
        (&["x [m]", "y [m]", "vx [m/s]", "vy [m/s]", "take"], None, Some(4), &[0, 1], &[2, 3]),
        (&["Episode ID", "Time (s)", "pos x", "pos y", "vel x", "vel y"], Some(1), Some(0), &[2, 3], &[4, 5]),
        (&["x1", "y1", "v", "vel"], None, None, &[0, 1, 2, 3], &[]),
    ] {
        let roles = by_name(names);
        assert_eq!((roles.time, roles.episode), (time, episode), "{names:?}");
        assert_eq!((&roles.state[..], &roles.velocity[..]), (state, velocity), "{names:?}");
    }
}

#[test]
fn some_velocities_are_too_few() {
    let error = assign(&columns(&["x", "y", "vx"]), &ReadOptions::default(), "here").unwrap_err();
    assert_eq!(error.code(), "NoRoles");
    assert!(error.to_string().contains("'y'"), "{error}");
}

#[test]
fn explicit_options_override_usual_names() {
    let names = ["a", "b", "vx", "x", "t"];
    let options = ReadOptions {
        state: vec!["b,a".to_owned()],
        velocity: vec!["x".to_owned(), "vx".to_owned()],
        time: Some("t".to_owned()),
        ..ReadOptions::default()
    };
    let roles = assigned(&names, &options);
    assert_eq!((roles.state, roles.velocity), (vec![1, 0], vec![3, 2]));
    let options = ReadOptions { ignore: vec!["v*".to_owned()], ..ReadOptions::default() };
    let roles = assigned(&names, &options);
    assert_eq!((roles.state, roles.velocity, roles.time), (vec![0, 1, 3], vec![], Some(4)));
}

#[test]
fn a_row_number_must_count() {
    let mut columns = columns(&["frame", "x"]);
    columns[0].content = Content::Numbers;
    assert_eq!(assign(&columns, &ReadOptions::default(), "here").unwrap().state, [0, 1]);
}

#[test]
fn duplicate_names_are_refused_unless_numbered() {
    let names = columns(&["episode", "t", "x", "y", "x", "y"]);
    let error = assign(&names, &ReadOptions::default(), "here").unwrap_err();
    assert_eq!(error.code(), "AmbiguousColumn");
    assert!(error.to_string().contains("columns 2 and 4"), "{error}");
    let options = ReadOptions { state: vec!["2-3".to_owned()], ..ReadOptions::default() };
    assert_eq!(assign(&names, &options, "here").unwrap().state, [2, 3]);
}

#[test]
fn units_stand_in_brackets() {
    assert_eq!(unit("x [mm]"), Some("mm"));
    assert_eq!(unit("angle(°)"), Some("°"));
    assert_eq!(unit("position[0]"), None);
    assert_eq!(unit("[m]"), None);
    assert_eq!(unit("é]"), None);
}

#[test]
fn goals_need_no_velocity() {
    let roles = by_name(&["t", "x", "y", "vx", "vy", "goal_x", "goal_y"]);
    assert_eq!((&roles.state[..], &roles.velocity[..], &roles.context[..]), (&[1, 2][..], &[3, 4][..], &[5, 6][..]));
    // Without velocities all columns are state; `prepare` separates the context.
    let roles = by_name(&["t", "x", "goal_x"]);
    assert_eq!((&roles.state[..], &roles.context[..]), (&[1, 2][..], &[][..]));
    let named = ReadOptions { context: vec!["c".to_owned()], state: vec!["x,c".to_owned()], ..ReadOptions::default() };
    let roles = assigned(&["t", "x", "vx", "c", "y"], &named);
    assert_eq!((&roles.state[..], &roles.velocity[..], &roles.context[..]), (&[1][..], &[2][..], &[3][..]));
}

#[test]
fn the_velocity_of_a_context_is_no_state() {
    let names = ["t", "x", "vx", "load", "vload"];
    let options = ReadOptions { context: vec!["load".to_owned()], ..ReadOptions::default() };
    let roles = assigned(&names, &options);
    assert_eq!((&roles.state[..], &roles.velocity[..], &roles.context[..]), (&[1][..], &[2][..], &[3][..]));
    assert_eq!(roles.ignored, [4]);
}
