"""Better than its constrained teacher: an arm learns to reach from demonstrations with the hand bound to a plane.

    python reach.py record demonstrations      # MuJoCo: five data sets of 50 demonstrations, each in a random plane
    python reach.py compare demonstrations     # learns offline, then tries the policies in MuJoCo
    python reach.py film reach.gif             # needs a renderer, as MUJOCO_GL=osmesa or egl

Needs ``policy_align``, ``mujoco``, ``scikit-learn`` and, for the film, ``pillow``. Metres and seconds; z is up.
"""

from __future__ import annotations

import argparse
import csv
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np

from policy_align import AutoGp, Demonstrations, DirectGp, PolicyAlignWarning

GOAL = np.array([0.45, 0.0, 0.3])
SHOULDER = np.array([0.0, 0.0, 0.3])
POST = np.array([0.45, 0.16])  # position of a vertical post
LINK = 0.35  # length of the upper arm, and of the forearm
CONTROL = 0.02  # seconds between two commands
ARRIVED = 0.02  # distance to the goal at which the hand has arrived
LIMIT = 30.0  # longest movement, in seconds

Policy = Callable[[np.ndarray], np.ndarray]
Normal = Callable[[np.ndarray], np.ndarray]


def teacher(x: np.ndarray) -> np.ndarray:
    """The velocity (3) that the teacher wants at the hand's position: 0.2 m/s to the goal, slower near it, around the post."""
    to_goal, from_post = GOAL - x, x[:2] - POST
    velocity = 0.2 * to_goal / np.sqrt(to_goal @ to_goal + 0.05**2)
    velocity[:2] += 0.015 / 0.06**2 * from_post * np.exp(-(from_post @ from_post) / (2 * 0.06**2))
    return velocity


class Arm:
    """The simulated arm; its hand follows velocities."""

    def __init__(self) -> None:
        self.model = mujoco.MjModel.from_xml_path(str(Path(__file__).with_name("arm.xml")))
        self.data = mujoco.MjData(self.model)
        self._hand = self.model.site("hand").id
        self._jacobian = np.zeros((3, 3))

    @property
    def hand(self) -> np.ndarray:
        return self.data.site_xpos[self._hand].copy()

    def velocity(self) -> np.ndarray:
        mujoco.mj_jacSite(self.model, self.data, self._jacobian, None, self._hand)
        return self._jacobian @ self.data.qvel

    def place(self, x: np.ndarray) -> None:
        """Sets the arm at rest with the hand at x, elbow up."""
        (across, up), far = (np.hypot(x[0], x[1]), x[2] - SHOULDER[2]), np.linalg.norm(x - SHOULDER)
        bend = np.arccos(far / (2 * LINK))
        mujoco.mj_resetData(self.model, self.data)
        self.data.qpos[:] = [np.arctan2(x[1], x[0]), -np.arctan2(up, across) - bend, 2 * bend]
        mujoco.mj_forward(self.model, self.data)

    def follow(self, velocity: np.ndarray) -> None:
        """Moves the hand at this velocity for CONTROL seconds, by damped least squares."""
        mujoco.mj_jacSite(self.model, self.data, self._jacobian, None, self._hand)
        weighed = self._jacobian @ self._jacobian.T + 1e-6 * np.eye(3)
        self.data.ctrl[:] = self._jacobian.T @ np.linalg.solve(weighed, velocity)
        mujoco.mj_step(self.model, self.data, round(CONTROL / self.model.opt.timestep))


def start(rng: np.random.Generator) -> np.ndarray:
    """A random position within reach, away from the goal and the post."""
    while True:
        x = rng.uniform([0.28, -0.3, 0.1], [0.58, 0.3, 0.5])
        if np.linalg.norm(x - GOAL) > 0.2 and np.linalg.norm(x - SHOULDER) < 0.66 and np.linalg.norm(x[:2] - POST) > 0.05:
            return x


def plane(rng: np.random.Generator) -> np.ndarray:
    normal = rng.normal(size=3)
    return normal / np.linalg.norm(normal)


def outward(x: np.ndarray) -> np.ndarray:
    """Normal of a sphere around the shoulder: the arm's extension is locked. No demonstration had a curved constraint."""
    return (x - SHOULDER) / np.linalg.norm(x - SHOULDER)


def on_sphere(x: np.ndarray) -> np.ndarray:
    """The nearest point of the sphere through the goal."""
    return SHOULDER + outward(x) * np.linalg.norm(GOAL - SHOULDER)


def bound(velocity: np.ndarray, normal: np.ndarray) -> np.ndarray:
    return velocity - normal * (normal @ velocity)


def record(path: Path, seed: int, episodes: int = 50, seconds: float = 6.0) -> int:
    """Writes demonstrations of the teacher, each with the hand bound to a different plane; returns how many reach the goal."""
    rng, arm, reached = np.random.default_rng(seed), Arm(), 0
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow("episode t x y z vx vy vz".split())
        for episode in range(episodes):
            arm.place(start(rng))
            normal = plane(rng)
            for sample in range(round(seconds / CONTROL)):
                arm.follow(bound(teacher(arm.hand), normal))
                if sample % 3 == 2:
                    numbers = [(sample + 1) * CONTROL, *arm.hand, *arm.velocity()]
                    rows.writerow([episode, *(f"{number:.6f}" for number in numbers)])
            reached += bool(np.linalg.norm(arm.hand - GOAL) < ARRIVED)
    return reached


def network(demonstrations: Demonstrations, at_rest: bool = True) -> Policy:
    """Behaviour cloning: velocities by a network of two hidden layers, with or without the samples at rest."""
    from sklearn.neural_network import MLPRegressor

    states, velocities = np.concatenate(list(demonstrations)), np.concatenate(demonstrations.velocities)
    if not at_rest:
        moving = np.linalg.norm(velocities, axis=1) > 0.01
        states, velocities = states[moving], velocities[moving]
    centre, width, speed = states.mean(axis=0), states.std(axis=0), velocities.std()
    learnt = MLPRegressor(hidden_layer_sizes=(64, 64), max_iter=300, random_state=1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # 300 passes may not have converged
        learnt.fit((states - centre) / width, velocities / speed)
    return lambda x: learnt.predict([(x - centre) / width])[0] * speed


def learnt(demonstrations: Demonstrations) -> dict[str, Policy]:
    """The policies that the learners learn from the same recordings, without a step of the simulator."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PolicyAlignWarning)  # cloning is not trustworthy here
        ours, direct = AutoGp().fit(demonstrations), DirectGp().fit(demonstrations)
    return {
        "policy-align": ours.act,
        # It has little support here; where it has none, it would stand still.
        "cloning, Gaussian process": lambda x: direct.act(x, outside="extrapolate"),
        "cloning, network": network(demonstrations),
        "cloning, network, moving samples only": network(demonstrations, at_rest=False),
    }


def attempt(arm: Arm, x: np.ndarray, policy: Policy, normal: Normal | None = None, limit: float = LIMIT) -> float:
    """Seconds until the hand is at the goal; ``limit`` if it does not arrive."""
    arm.place(x)
    for step in range(round(limit / CONTROL)):
        if np.linalg.norm(arm.hand - GOAL) < ARRIVED:
            return step * CONTROL
        velocity = policy(arm.hand)
        arm.follow(velocity if normal is None else bound(velocity, normal(arm.hand)))
    return limit


def attempts(policy: Policy, starts: list[np.ndarray], limit: float = LIMIT) -> np.ndarray:
    """Seconds from each start, free and on the sphere, (2, starts)."""
    arm = Arm()
    free = [attempt(arm, x, policy, limit=limit) for x in starts]
    return np.array([free, [attempt(arm, on_sphere(x), policy, outward, limit) for x in starts]])


def compare(folder: Path, n_starts: int = 20) -> dict[str, np.ndarray]:
    """Prints and returns the seconds of each learner, (data sets, 2, starts)."""
    found: dict[str, list[np.ndarray]] = {}
    for file in sorted(folder.glob("*.csv")):
        rng = np.random.default_rng([99, len(found.get("teacher, free", []))])
        starts = [start(rng) for _ in range(n_starts)]
        began = time.perf_counter()
        policies = {"teacher, free": teacher, **learnt(Demonstrations.read(file))}
        print(f"{file}: learnt in {time.perf_counter() - began:.0f} s", flush=True)
        for name, policy in policies.items():
            found.setdefault(name, []).append(attempts(policy, starts))
    seconds = {name: np.array(of_all) for name, of_all in found.items()}
    print_table(seconds)
    return seconds


def print_table(seconds: dict[str, np.ndarray]) -> None:
    """Prints Markdown: means, and standard deviations over data sets; attempts that do not arrive count as LIMIT."""
    print("\n| | free: arrives | seconds | on the sphere: arrives | seconds |\n|---|---|---|---|---|")
    for name, of_all in seconds.items():
        cells = [f"{np.mean(kind < LIMIT):.0%} | {kind.mean():.3g} ± {kind.mean(axis=1).std():.1g}" for kind in of_all.swapaxes(0, 1)]
        print(f"| {name} | {' | '.join(cells)} |")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("verb", choices=["record", "compare", "film"])
    parser.add_argument("path", type=Path, help="folder of demonstrations, or the film to write")
    parser.add_argument("--data-sets", type=int, default=5)
    parser.add_argument("--starts", type=int, default=20)
    given = parser.parse_args()
    if given.verb == "record":
        given.path.mkdir(exist_ok=True)
        for seed in range(1, given.data_sets + 1):
            reached = record(given.path / f"{seed}.csv", seed)
            print(f"{given.path / f'{seed}.csv'}: {reached} of 50 demonstrations reach the goal")
    elif given.verb == "compare":
        compare(given.path, given.starts)
    else:
        from film import film

        film(given.path)
