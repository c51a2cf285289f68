"""A robot in MCAP files, as read by viewers, compared with separate forward kinematics in NumPy."""

from __future__ import annotations

import subprocess
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

#: Revolute, prismatic, fixed and mimic joints, with axes and origins at various angles.
ROBOT = """<robot name="press">
  <link name="world"/><link name="column"/><link name="plate"/><link name="thumb"/>
  <link name="ram"><visual><geometry><box size="0.1 0.1 0.2"/></geometry></visual></link>
  <link name="finger"><visual><geometry><box size="0.1 0.1 0.2"/></geometry></visual></link>
  <joint name="turn" type="continuous"><parent link="world"/><child link="column"/>
    <origin xyz="0.1 -0.2 0.3" rpy="0.4 -0.5 0.6"/><axis xyz="1 2 -3"/></joint>
  <joint name="lift" type="prismatic"><parent link="column"/><child link="ram"/>
    <origin xyz="0 0 1" rpy="1.2 0 -0.7"/><axis xyz="0.5 0 -1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="screw" type="fixed"><parent link="ram"/><child link="plate"/><origin xyz="0.3 0 0" rpy="0 3 0"/></joint>
  <joint name="grip" type="revolute"><parent link="plate"/><child link="finger"/><axis xyz="0 0 -1"/>
    <limit lower="-4" upper="4" effort="1" velocity="1"/></joint>
  <joint name="follow" type="revolute"><parent link="plate"/><child link="thumb"/><axis xyz="0 1 0"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/><mimic joint="grip" multiplier="-2" offset="0.1"/></joint></robot>"""

SAMPLES = 40
JOINTS = ["turn", "lift", "grip"]


def positions() -> np.ndarray:
    """Joint positions of two movements, (2, SAMPLES, 3)."""
    times = 0.05 * np.arange(SAMPLES)
    return np.array(
        [[[np.sin(t + e), 0.4 * np.cos(2 * t), 3 * np.sin(0.7 * t + e)] for t in times] for e in range(2)]
    )


@pytest.fixture(scope="module")
def bag(program: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("robot")
    rows = [
        [episode, 0.05 * i, *state] for episode, movement in enumerate(positions()) for i, state in enumerate(movement)
    ]
    text = "\n".join(",".join(map(repr, map(float, row))) for row in rows)
    (folder / "press.csv").write_text("episode,t," + ",".join(JOINTS) + "\n" + text + "\n")
    (folder / "press.urdf").write_text(ROBOT)
    command = [program, "convert", "press.csv", "-o", "press.mcap", "--robot", "press.urdf"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return folder / "press.mcap"


def turned(axis: np.ndarray, angle: float) -> np.ndarray:
    """The rotation about an axis, by Rodrigues' formula."""
    x, y, z = axis / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def numbers(element: ET.Element | None, name: str, default: str) -> np.ndarray:
    return np.array([float(word) for word in (default if element is None else element.get(name, default)).split()])


def expected(state: np.ndarray) -> dict[str, tuple[str, np.ndarray]]:
    """From the URDF text alone: the parent of each link, and the pose in the parent's frame, (4, 4)."""
    values = dict(zip(JOINTS, state, strict=True))
    values["follow"] = -2 * values["grip"] + 0.1
    found = {}
    for joint in ET.fromstring(ROBOT).iter("joint"):
        origin, axis = joint.find("origin"), numbers(joint.find("axis"), "xyz", "1 0 0")
        roll, pitch, yaw = numbers(origin, "rpy", "0 0 0")
        pose, moved = np.eye(4), np.eye(4)
        pose[:3, :3] = turned(np.eye(3)[2], yaw) @ turned(np.eye(3)[1], pitch) @ turned(np.eye(3)[0], roll)
        pose[:3, 3] = numbers(origin, "xyz", "0 0 0")
        if joint.get("type") == "prismatic":
            moved[:3, 3] = axis / np.linalg.norm(axis) * values[joint.get("name")]
        elif joint.get("type") != "fixed":
            moved[:3, :3] = turned(axis, values[joint.get("name")])
        found[joint.find("child").get("link")] = (joint.find("parent").get("link"), pose @ moved)
    return found


def matrix(x: float, y: float, z: float, w: float) -> np.ndarray:
    """The rotation of a quaternion."""
    v = np.array([x, y, z])
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return (w * w - v @ v) * np.eye(3) + 2 * np.outer(v, v) + 2 * w * k


def compare(transforms: list, state: np.ndarray) -> None:
    truth = expected(state)
    assert [transform.child_frame_id for transform in transforms] == list(truth)
    for transform in transforms:
        parent, pose = truth[transform.child_frame_id]
        assert transform.header.frame_id == parent
        at, turn = transform.transform.translation, transform.transform.rotation
        np.testing.assert_allclose([at.x, at.y, at.z], pose[:3, 3], atol=1e-12)
        np.testing.assert_allclose(matrix(turn.x, turn.y, turn.z, turn.w), pose[:3, :3], atol=1e-12)


def test_the_library_of_the_format_finds_links_where_they_are(bag: Path) -> None:
    reader = pytest.importorskip("mcap.reader", reason="mcap is not installed")
    ros2 = pytest.importorskip("mcap_ros2.decoder", reason="mcap-ros2-support is not installed")
    states = positions().reshape(-1, 3)
    with bag.open("rb") as file:
        messages = list(reader.make_reader(file, decoder_factories=[ros2.DecoderFactory()]).iter_decoded_messages())
    by_topic: dict[str, list] = {}
    for _, channel, message, decoded in messages:
        by_topic.setdefault(channel.topic, []).append((message.log_time, decoded))
    assert {topic: len(found) for topic, found in by_topic.items()} == {
        "/robot_description": 1, "/tf": len(states), "/joint_states": len(states)
    }
    assert by_topic["/robot_description"][0][1].data == ROBOT
    for (at, moved), (joint_at, joints), state in zip(by_topic["/tf"], by_topic["/joint_states"], states, strict=True):
        assert at == joint_at
        np.testing.assert_array_equal(joints.position, state)
        compare(moved.transforms, state)
        stamps = {(t.header.stamp.sec, t.header.stamp.nanosec) for t in moved.transforms}
        assert stamps == {(joints.header.stamp.sec, joints.header.stamp.nanosec)}


def test_rosbags_decodes_every_message(bag: Path) -> None:
    highlevel = pytest.importorskip("rosbags.highlevel", reason="rosbags is not installed")
    from rosbags.typesys import Stores, get_typestore

    states, seen = positions().reshape(-1, 3), 0
    with highlevel.AnyReader([bag], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
        for connection, _, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            if connection.topic == "/tf":
                compare(message.transforms, states[seen])
                seen += 1
            elif connection.topic == "/robot_description":
                assert message.data == ROBOT
    assert seen == len(states)


def test_rerun_finds_the_robot_and_moves_its_links(bag: Path) -> None:
    chunk = pytest.importorskip("rerun.chunk", reason="rerun-sdk 0.41 or newer is not installed")
    moved, entities = [], set()
    for part in chunk.McapReader(bag).stream():
        entities.add(str(part.entity_path))
        columns = part.to_record_batch().to_pydict()
        names = [f"Transform3D:{name}" for name in ("parent_frame", "child_frame", "translation", "quaternion")]
        if all(name in columns for name in names):
            moved += zip(*(columns[name] for name in names), strict=True)
    # The importer reads the URDF from a topic of this name, and draws the visual geometry of every link.
    assert {"/press", "/robot_description"} <= entities
    assert {f"/press/visual_geometries/{link}/visual_0" for link in ("ram", "finger")} <= entities
    states = positions().reshape(-1, 3)
    assert len(moved) == len(states) * len(expected(states[0]))
    for at, state in enumerate(states):
        truth = expected(state)
        for [parent], [child], [translation], [quaternion] in moved[at * len(truth) : (at + 1) * len(truth)]:
            assert parent == truth[child][0]
            # Rerun stores single precision.
            np.testing.assert_allclose(translation, truth[child][1][:3, 3], atol=1e-6)
            np.testing.assert_allclose(matrix(*quaternion), truth[child][1][:3, :3], atol=1e-6)
