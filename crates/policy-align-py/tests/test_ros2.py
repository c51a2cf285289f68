"""`policy-align serve --ros2` with a robot that uses another implementation of DDS, on this machine."""

import json
import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed")
#: The robot is visible on this machine alone, and announces itself every half second (every 8 seconds by default).
os.environ["CYCLONEDDS_URI"] = """<CycloneDDS><Domain>
  <General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces></General>
  <Discovery><SPDPInterval>500ms</SPDPInterval></Discovery></Domain></CycloneDDS>"""

from cyclonedds.core import Policy, Qos  # noqa: E402
from cyclonedds.domain import DomainParticipant  # noqa: E402
from cyclonedds.idl import IdlStruct  # noqa: E402
from cyclonedds.idl.types import float64, int32, sequence, uint32  # noqa: E402
from cyclonedds.pub import DataWriter  # noqa: E402
from cyclonedds.sub import DataReader  # noqa: E402
from cyclonedds.topic import Topic  # noqa: E402
from cyclonedds.util import duration  # noqa: E402

#: Separates tests that run on one machine at the same time.
DOMAIN = 100 + os.getpid() % 100
#: As in controllers and robots of ros2_control.
RELIABLE = Qos(
    Policy.Reliability.Reliable(duration(milliseconds=100)), Policy.Durability.Volatile, Policy.History.KeepLast(100)
)
#: Seconds allowed for discovery and a busy machine.
PATIENCE = 30


@dataclass
class Time(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    sec: int32
    nanosec: uint32


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    stamp: Time
    frame_id: str


@dataclass
class JointState(IdlStruct, typename="sensor_msgs::msg::dds_::JointState_"):
    header: Header
    name: sequence[str]
    position: sequence[float64]
    velocity: sequence[float64]
    effort: sequence[float64]


@dataclass
class Dimension(IdlStruct, typename="std_msgs::msg::dds_::MultiArrayDimension_"):
    label: str
    size: uint32
    stride: uint32


@dataclass
class Layout(IdlStruct, typename="std_msgs::msg::dds_::MultiArrayLayout_"):
    dim: sequence[Dimension]
    data_offset: uint32


@dataclass
class Array(IdlStruct, typename="std_msgs::msg::dds_::Float64MultiArray_"):
    layout: Layout
    data: sequence[float64]


class Robot:
    """Publishes joint states and receives commands."""

    def __init__(self, commands: str, kind: type[IdlStruct]) -> None:
        participant = DomainParticipant(DOMAIN)
        states = Topic(participant, "rt/joint_states", JointState, qos=RELIABLE)
        self.writer = DataWriter(participant, states, qos=RELIABLE)
        self.reader = DataReader(participant, Topic(participant, commands, kind, qos=RELIABLE), qos=RELIABLE)

    def is_at(self, **joints: float) -> None:
        names, positions = list(joints), list(joints.values())
        self.writer.write(JointState(Header(Time(0, 0), ""), names, positions, [], []))

    def commands(self) -> list[Any]:
        """The commands since the last call; a departing publisher appears as a sample without data, which is dropped."""
        return [sample for sample in self.reader.take(1000) if hasattr(sample, "header") or hasattr(sample, "data")]

    def moves_on(self, wanted: Callable[[Any], bool], **joints: float) -> Any:
        """Stays in place until a wanted command arrives."""
        end, last = time.monotonic() + PATIENCE, None
        while time.monotonic() < end:
            if joints:
                self.is_at(**joints)
            for last in self.commands():
                if wanted(last):
                    return last
            time.sleep(0.01)
        raise AssertionError(f"after {PATIENCE} s the last command was {last}")


@pytest.fixture(scope="module")
def model(program: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    served = subprocess.run([program, "serve", "--help"], check=True, capture_output=True, text=True)
    if "--ros2" not in served.stdout:
        pytest.skip(f"{program} is built without ROS 2: cargo build -p policy-align --features ros2")
    folder = tmp_path_factory.mktemp("ros2")
    toy = Path(__file__).parents[3] / "docs/examples/toy.csv"
    subprocess.run([program, "fit", toy, "-o", folder / "toy.json", "--quiet"], check=True, capture_output=True)
    return folder / "toy.json"


@pytest.fixture
def serve(program: Path, model: Path) -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Starts the program; kills it at the end if it still runs."""
    started: list[subprocess.Popen[str]] = []

    def start(*flags: str, local: str = "1") -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [program, "serve", model, "--ros2", *flags],
            env={**os.environ, "ROS_DOMAIN_ID": str(DOMAIN), "ROS_LOCALHOST_ONLY": local},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        started.append(process)
        return process

    yield start
    for process in started:
        if process.poll() is None:
            process.kill()
        process.communicate()


def predicted(program: Path, model: Path, states: list[tuple[float, float]]) -> list[list[float]]:
    text = "x,y\n" + "".join(f"{x!r},{y!r}\n" for x, y in states)
    command = [program, "predict", model, "-", "--json"]
    output = subprocess.run(command, check=True, capture_output=True, text=True, input=text).stdout
    return [prediction["action"] for prediction in json.loads(output)["predictions"]]


@pytest.mark.parametrize("local", ["0", "1"])
def test_commands_are_predictions_to_the_bit(
    program: Path, model: Path, serve: Callable[..., subprocess.Popen[str]], local: str
) -> None:
    states = [(0.3, 1.2), (-0.25, 0.5), (1 / 3, -0.1), (0.7, 0.7)]
    robot, process = Robot("rt/velocity_controller/commands", Array), serve(local=local)
    for (x, y), action in zip(states, predicted(program, model, states), strict=True):
        assert any(action)
        # The robot has its joints in another order, and one more.
        command = robot.moves_on(lambda command, action=action: list(command.data) == action, grip=9.0, y=y, x=x)
        assert not command.layout.dim and command.layout.data_offset == 0
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, err
    assert "zero at the end" in out and "moving: the state is within the data" in err
    assert err.count("moving:") == 1, err


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM])
def test_the_last_command_is_zero(serve: Callable[..., subprocess.Popen[str]], end: signal.Signals) -> None:
    robot, process = Robot("rt/velocity_controller/commands", Array), serve("--rate", "200")
    robot.moves_on(lambda command: any(command.data), x=0.3, y=1.2)
    # New states arrive until it has ended, so that only the end stops the robot.
    process.send_signal(end)
    last = None
    while process.poll() is None:
        robot.is_at(x=0.3, y=1.2)
        for last in robot.commands():
            pass
        time.sleep(0.005)
    for last in robot.commands():
        pass
    assert last is not None and list(last.data) == [0.0, 0.0]
    assert process.returncode == 0


def test_it_stands_where_it_must_and_says_why(serve: Callable[..., subprocess.Popen[str]]) -> None:
    robot, process = Robot("rt/velocity_controller/commands", Array), serve("--json", "--stale", "0.5")

    def stands(command: Any) -> bool:
        return list(command.data) == [0.0, 0.0]

    def moves(command: Any) -> bool:
        return any(command.data)

    # A robot cannot distinguish zero before the first state from zero for a missing joint; the lines of the program can.
    assert process.stdout is not None
    lines: list[dict[str, Any]] = []
    while not lines or lines[-1]["halt"] != "missing":
        robot.is_at(x=0.3)
        lines.append(json.loads(process.stdout.readline()))
    robot.moves_on(moves, x=0.3, y=1.2)
    robot.moves_on(stands, x=30.0, y=1.2)
    robot.moves_on(moves, x=0.3, y=1.2)
    robot.moves_on(stands, x=float("nan"), y=1.2)
    robot.moves_on(moves, x=0.3, y=1.2)
    robot.moves_on(stands)  # no more states
    robot.moves_on(moves, y=1.2, x=0.3)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, err
    *others, total = map(json.loads, out.splitlines())
    lines += others
    halts = [line["halt"] for line in lines]
    changes = [halt for halt, before in zip(halts, [0, *halts], strict=False) if halt != before]
    # States may be late more often on a busy machine.
    assert changes[:2] == ["no state", "missing"], changes
    assert set(changes[2:]) == {None, "outside", "not finite", "stale"}, changes
    assert all((line["halt"] is None) == any(line["velocities"]) for line in lines)
    whys = {line["halt"]: line["why"] for line in lines}
    assert whys["missing"] == "no position of y; joints of the last message: x"
    assert whys["not finite"] == "the position of x is NaN"
    assert total["commands"] >= total["zero"] > 0


def test_joint_states_as_commands_under_other_names(
    program: Path, model: Path, serve: Callable[..., subprocess.Popen[str]]
) -> None:
    action = predicted(program, model, [(0.3, 1.2)])[0]
    robot = Robot("rt/joint_command", JointState)
    process = serve("--as", "joint-state", "--joints", "y=lift,x=turn", "--seconds", str(PATIENCE))
    command = robot.moves_on(lambda command: any(command.velocity), turn=0.3, lift=1.2)
    assert list(command.name) == ["lift", "turn"]
    assert list(command.velocity) == action[::-1]
    assert not command.position and not command.effort
    assert abs(command.header.stamp.sec - time.time()) < PATIENCE
    assert process.poll() is None


def test_what_is_wrong_is_said(program: Path, model: Path) -> None:
    def refused(*flags: str, domain: str = str(DOMAIN)) -> list[str]:
        command = [program, "serve", model, "--ros2", *flags]
        environment = {**os.environ, "ROS_DOMAIN_ID": domain, "ROS_LOCALHOST_ONLY": "1"}
        ran = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=PATIENCE)
        assert ran.returncode == 2, ran
        return ran.stderr.splitlines()

    assert refused(domain="233") == [
        "error: '233' is not a domain of ROS 2: 0 to 232",
        "  in:  the environment's ROS_DOMAIN_ID",
        "  try: the number that the robot has",
    ]
    assert refused("--topic", "states")[0].startswith("error: 'states' is not a full name of a topic")
    assert refused("--rate", "0")[1] == "  in:  --rate 0 --stale 0.2"
    assert refused("--rate", "1")[1] == "  in:  --rate 1 --stale 0.2"
    assert refused("--stale", "nan")[0] == "error: stale is NaN"
    assert refused("--seconds", "0")[1] == "  in:  --seconds 0"
    assert refused("--joints", "x=a,y=a")[0] == "error: 'a' is named twice"
    assert refused("--context", "goal=1")[0].startswith("error: the model's context has no 'goal'")
