//! A robot in MCAP files for viewers, read back with the format's library.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![cfg(feature = "mcap")]

mod running;

use mcap::{Message, MessageStream, Summary};
use motion::{Channel, Episode, Recordings, Source};
use nalgebra::{DMatrix, DVector, Isometry3, Quaternion, Translation3, UnitQuaternion};
use policy_align::kinematics::{RobotModel, Workspace};
use policy_align::{RobotFrames, demo_io, motion};
use proptest::prelude::*;
use running::{folder, run};

/// Rotating, sliding, fixed and mimic joints, with oblique axes and origins.
const ROBOT: &str = r#"<robot name="press">
  <link name="world"/><link name="column"/><link name="ram"/><link name="plate"/><link name="finger"/><link name="thumb"/>
  <joint name="turn" type="continuous"><parent link="world"/><child link="column"/>
    <origin xyz="0.1 -0.2 0.3" rpy="0.4 -0.5 0.6"/><axis xyz="1 2 -3"/></joint>
  <joint name="lift" type="prismatic"><parent link="column"/><child link="ram"/>
    <origin xyz="0 0 1" rpy="1.2 0 -0.7"/><axis xyz="0.5 0 -1"/><limit lower="-1" upper="1"/></joint>
  <joint name="screw" type="fixed"><parent link="ram"/><child link="plate"/><origin xyz="0.3 0 0" rpy="0 3 0"/></joint>
  <joint name="grip" type="revolute"><parent link="plate"/><child link="finger"/><axis xyz="0 0 -1"/>
    <limit lower="-4" upper="4"/></joint>
  <joint name="follow" type="revolute"><parent link="plate"/><child link="thumb"/><axis xyz="0 1 0"/>
    <limit lower="-9" upper="9"/><mimic joint="grip" multiplier="-2" offset="0.1"/></joint></robot>"#;

fn recordings(channels: &[(&str, Option<&str>)], episodes: &[DMatrix<f64>]) -> Recordings {
    let episode = |(number, positions): (usize, &DMatrix<f64>)| Episode {
        name: format!("take {number}"),
        source: Source { file: "made".to_owned(), records: None },
        times: (0..positions.ncols()).map(|sample| sample as f64 * 0.1).collect(),
        positions: positions.clone(),
        velocities: None,
        constraint: None,
        context: DVector::zeros(0),
    };
    let channel =
        |&(name, unit): &(&str, Option<&str>)| Channel { name: name.to_owned(), unit: unit.map(str::to_owned) };
    Recordings {
        state: channels.iter().map(channel).collect(),
        episodes: episodes.iter().enumerate().map(episode).collect(),
        findings: vec![],
    }
}

/// Decodes the bytes of a ROS 2 message by its definition.
struct Cdr<'a>(&'a [u8], usize);

impl<'a> Cdr<'a> {
    fn of(message: &'a [u8]) -> Self {
        assert_eq!(message[..4], [0, 1, 0, 0], "little-endian");
        Cdr(&message[4..], 0)
    }

    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        let at = self.1.next_multiple_of(N);
        self.1 = at + N;
        self.0[at..at + N].try_into().unwrap()
    }

    fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.bytes())
    }

    fn f64(&mut self) -> f64 {
        f64::from_le_bytes(self.bytes())
    }

    fn text(&mut self) -> &'a str {
        let (length, at) = (self.u32() as usize, self.1);
        self.1 += length;
        assert_eq!(self.0[at + length - 1], 0);
        std::str::from_utf8(&self.0[at..at + length - 1]).unwrap()
    }

    /// Stamp in nanoseconds, parent, child and pose of each transform.
    fn transforms(mut self) -> Vec<(u64, &'a str, &'a str, Isometry3<f64>)> {
        let transform = |cdr: &mut Self| {
            let stamp = u64::from(cdr.u32()) * 1_000_000_000 + u64::from(cdr.u32());
            let (parent, child) = (cdr.text(), cdr.text());
            let [x, y, z, i, j, k, w] = std::array::from_fn(|_| cdr.f64());
            let rotation = Quaternion::new(w, i, j, k);
            assert!((rotation.norm() - 1.0).abs() < 1e-12);
            let pose = Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::new_unchecked(rotation));
            (stamp, parent, child, pose)
        };
        let found = (0..self.u32()).map(|_| transform(&mut self)).collect();
        assert_eq!(self.1, self.0.len(), "nothing is left");
        found
    }
}

fn written(urdf: &str, made: &Recordings) -> &'static [u8] {
    let path = tempfile::tempdir().unwrap().keep().join("a.mcap");
    demo_io::write_with_robot(&path, made, &RobotFrames::from_urdf(urdf, &made.state, &[]).unwrap()).unwrap();
    let bytes: &'static [u8] = std::fs::read(&path).unwrap().leak();
    let back = demo_io::read(&path, &demo_io::ReadOptions::default(), &mut |_| ()).unwrap();
    let positions = |recordings: &Recordings| -> Vec<_> {
        recordings.episodes.iter().map(|episode| (episode.name.clone(), episode.positions.clone())).collect()
    };
    assert_eq!((&back.state, positions(&back)), (&made.state, positions(made)), "the robot is in no one's way");
    std::fs::remove_dir_all(path.parent().unwrap()).unwrap();
    bytes
}

/// Compares every transform with forward kinematics at `q(state)`.
fn compare(urdf: &str, made: &Recordings, q: impl Fn(DVector<f64>) -> DVector<f64>) {
    let robot = RobotModel::from_urdf(urdf).unwrap();
    let messages: Vec<Message<'_>> = MessageStream::new(written(urdf, made)).unwrap().map(Result::unwrap).collect();
    let of = |topic: &str| -> Vec<_> { messages.iter().filter(|message| message.channel.topic == topic).collect() };
    let described = of("/robot_description");
    assert_eq!(described.len(), 1);
    assert_eq!(described[0].channel.schema.as_ref().unwrap().name, "std_msgs/msg/String");
    assert_eq!(Cdr::of(&described[0].data).text(), urdf);
    let (joints, moved) = (of("/joint_states"), of("/tf"));
    let states: Vec<_> = made.episodes.iter().flat_map(|episode| episode.positions.column_iter()).collect();
    assert_eq!((joints.len(), moved.len()), (states.len(), states.len()));
    for ((joint, moved), state) in joints.iter().zip(moved).zip(states) {
        assert_eq!(moved.channel.schema.as_ref().unwrap().name, "tf2_msgs/msg/TFMessage");
        let mut workspace = Workspace::new();
        let q = q(state.into_owned());
        let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
        let mut placed = vec![(robot.link_name(robot.root()), Isometry3::identity())];
        let transforms = Cdr::of(&moved.data).transforms();
        assert_eq!(transforms.len() + 1, robot.links().len(), "every link but the root");
        for (stamp, parent, child, pose) in transforms {
            assert_eq!((stamp, moved.log_time), (joint.log_time, joint.log_time));
            let above = placed.iter().find(|(link, _)| *link == parent).expect("a parent comes before its children").1;
            placed.push((child, above * pose));
        }
        for (link, pose) in placed {
            let expected = poses.pose(robot.link(link).unwrap()).to_homogeneous();
            assert!((pose.to_homogeneous() - expected).amax() < 1e-12, "{link}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Joints in another order than the file's, matched by name; one is not recorded.
    #[test]
    fn links_are_where_forward_kinematics_has_them(
        numbers in proptest::collection::vec(-4.0..4.0f64, 2 * 30),
        samples in 2usize..15,
    ) {
        let episodes = [&numbers[..2 * samples], &numbers[2 * samples..4 * samples]].map(|numbers| DMatrix::from_column_slice(2, samples, numbers));
        let made = recordings(&[("grip", None), ("turn", Some("rad"))], &episodes);
        compare(ROBOT, &made, |state| DVector::from_vec(vec![state[1], 0.0, state[0]]));
        let episodes = [DMatrix::from_column_slice(3, samples, &numbers[..3 * samples])];
        let made = recordings(&[("lift", Some("mm")), ("grip", Some("deg")), ("turn", None)], &episodes);
        compare(ROBOT, &made, |state| DVector::from_vec(vec![state[2], state[0] * 1e-3, state[1].to_radians()]));
        let made = recordings(&[("a", None), ("b", None), ("c", None)], &episodes);
        compare(ROBOT, &made, |state| state);
    }
}

/// Several chunks, whose index contains every message of every topic.
#[test]
fn a_long_recording_fills_several_chunks() {
    let urdf = std::fs::read_to_string("../../robots/seven_joint_arm.urdf").unwrap();
    let names: Vec<String> =
        RobotModel::from_urdf(&urdf).unwrap().joints().iter().map(|joint| joint.name().to_owned()).collect();
    let channels: Vec<_> = names.iter().map(|name| (&name[..], None)).collect();
    let positions = DMatrix::from_fn(names.len(), 1500, |row, column| (row as f64 + column as f64 * 0.01).sin());
    let made = recordings(&channels, &[positions]);
    compare(&urdf, &made, |state| state);

    let bytes = written(&urdf, &made);
    let summary = Summary::read(bytes).unwrap().unwrap();
    let statistics = summary.stats.as_ref().unwrap();
    assert_eq!((statistics.channel_count, statistics.schema_count, statistics.message_count), (3, 3, 3001));
    let mut counts: Vec<u64> = statistics.channel_message_counts.values().copied().collect();
    counts.sort_unstable();
    assert_eq!(counts, [1, 1500, 1500]);
    assert!(summary.chunk_indexes.len() > 1, "several chunks");
    let mut found = std::collections::BTreeMap::new();
    for chunk in &summary.chunk_indexes {
        let index = summary.read_message_indexes(bytes, chunk).unwrap();
        let streamed: Vec<Message<'_>> = summary.stream_chunk(bytes, chunk).unwrap().map(Result::unwrap).collect();
        for (channel, entries) in &index {
            let times = entries.iter().map(|entry| entry.log_time);
            let of_channel = streamed.iter().filter(|message| message.channel.id == channel.id);
            assert!(times.eq(of_channel.map(|message| message.log_time)), "{}", channel.topic);
            for entry in entries {
                let message = summary.seek_message(bytes, chunk, entry).unwrap();
                assert_eq!((message.channel.id, message.log_time), (channel.id, entry.log_time));
            }
            *found.entry(channel.topic.clone()).or_insert(0) += entries.len();
        }
    }
    let found: Vec<(&str, usize)> = found.iter().map(|(topic, count)| (&topic[..], *count)).collect();
    assert_eq!(found, [("/joint_states", 1500), ("/robot_description", 1), ("/tf", 1500)]);
    for topic in ["/joint_states", "/tf"] {
        let of_topic = MessageStream::new(bytes).unwrap().map(Result::unwrap);
        let sequences = of_topic.filter(|message| message.channel.topic == topic).map(|message| message.sequence);
        assert!(sequences.eq(0..1500), "no gap in {topic}");
    }
}

#[test]
fn robots_that_do_not_fit_are_refused() {
    let refused = |channels: &[(&str, Option<&str>)]| {
        let state = recordings(channels, &[]).state;
        RobotFrames::from_urdf(ROBOT, &state, &["goal".to_owned()]).map(|frames| frames.matching())
    };
    let message = refused(&[("x", None), ("y", None)]).unwrap_err();
    assert_eq!(message, "the state has 2 (x, y) channels and the robot 3 (turn, lift, grip) joints, of other names");
    let message = refused(&[("turn", None), ("lifd", None), ("grip", None)]).unwrap_err();
    assert!(message.contains("'lifd' is not a joint") && message.contains("turn, lift, grip"), "{message}");
    let message = refused(&[("turn", None), ("goal", None)]).unwrap();
    assert_eq!(message, "press: channels are joints by name; at 0: lift, grip");
    let message = refused(&[("x", None), ("goal", None), ("y", None), ("z", None)]).unwrap();
    assert_eq!(message, "press: channels are its joints turn, lift, grip in this order");
    assert!(RobotFrames::from_urdf("<robot", &[], &[]).is_err());
    // A state at which links cannot be placed.
    let made = recordings(&[("lift", None)], &[DMatrix::from_element(1, 2, 1e300)]);
    let path = tempfile::tempdir().unwrap().keep().join("far.mcap");
    let frames = RobotFrames::from_urdf(ROBOT, &made.state, &[]).unwrap();
    let message = demo_io::write_with_robot(&path, &made, &frames).unwrap_err().to_string();
    assert!(message.contains("episode 'take 0', sample 0") && message.contains("\"lift\""), "{message}");
    assert!(!path.exists(), "nothing is left of it");
    let message = demo_io::write_with_robot(&path.with_extension("csv"), &made, &frames).unwrap_err().to_string();
    assert_eq!(message, "files ending in '.csv' hold no robot; write .mcap");
}

#[test]
fn program_writes_robots_and_reports_faults() {
    std::fs::write(folder().join("press.urdf"), ROBOT).unwrap();
    let two = ROBOT.replace("type=\"continuous\"", "type=\"fixed\"");
    std::fs::write(folder().join("two.urdf"), two).unwrap();
    for line in [
        "convert toy.csv -o robot.mcap --robot two.urdf",
        "export toy.json --to mcap -o robot.mcap --robot two.urdf --from 1.5,1",
        "rollout toy.json --from 1.5,1 -o robot.mcap --robot two.urdf",
    ] {
        let ran = run(line);
        assert_eq!(ran.code, Some(0), "{line}: {}", ran.err);
        assert!(
            ran.out.contains("robot        press: channels are its joints lift, grip in this order"),
            "{}",
            ran.out
        );
        let bytes = std::fs::read(folder().join("robot.mcap")).unwrap();
        let topics = mcap::Summary::read(&bytes).unwrap().unwrap();
        let mut topics: Vec<&str> = topics.channels.values().map(|channel| &channel.topic[..]).collect();
        topics.sort_unstable();
        assert_eq!(topics, ["/joint_states", "/robot_description", "/tf"], "{line}");
    }
    for (line, code, said) in [
        (
            "convert toy.csv -o r.mcap --robot press.urdf",
            2,
            "2 (x, y) channels and the robot 3 (turn, lift, grip) joints",
        ),
        ("convert toy.csv -o r.csv --robot two.urdf", 2, "'.csv' hold no robot"),
        ("convert toy.csv -o two.urdf --robot two.urdf", 2, "read by the same command"),
        ("rollout toy.json --from 1.5,1 --robot two.urdf", 2, "a robot is only written to a file"),
        ("export toy.json --to c --robot two.urdf", 2, "only MCAP holds roll-outs"),
        ("convert toy.csv -o r.mcap --robot none.urdf", 3, "none.urdf"),
    ] {
        let ran = run(line);
        assert_eq!(ran.code, Some(code), "{line}: {}", ran.err);
        assert!(ran.err.contains(said) && ran.err.contains("try:"), "{line}: {}", ran.err);
    }
}
