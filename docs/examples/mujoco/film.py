"""The film of the README: a demonstration, behaviour cloning and policy-align from the same start."""

from __future__ import annotations

import tempfile
from pathlib import Path

import mujoco
import numpy as np
from PIL import Image, ImageDraw, ImageFont
from reach import ARRIVED, CONTROL, GOAL, Arm, Normal, Policy, bound, learnt, plane, record, start, teacher

from policy_align import Demonstrations

SIZE = (300, 290)
SECONDS, PER_SECOND = 6.0, 12.5
COLOURS = {"a demonstration, in its plane": "#7a7a7a", "cloning, network": "#d1495b", "policy-align": "#2a6fb0"}


def film(path: Path) -> None:
    """Writes an animated GIF. It learns from the first data set of ``record``."""
    with tempfile.TemporaryDirectory() as folder:
        record(Path(folder) / "1.csv", 1)
        policies = learnt(Demonstrations.read(Path(folder) / "1.csv"))
    rng = np.random.default_rng(1)
    x, normal = start(rng), plane(rng)
    shown: list[tuple[str, Policy, Normal | None]] = [
        ("a demonstration, in its plane", teacher, lambda _x: normal),
        ("cloning, network", policies["cloning, network"], None),
        ("policy-align", policies["policy-align"], None),
    ]
    panels = [frames(name, policy, x, of) for name, policy, of in shown]
    joined = [side_by_side(parts) for parts in zip(*panels, strict=True)]
    every = side_by_side(tuple(joined[:: len(joined) // 4]))
    colours = every.quantize(128, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    pictures = [picture.quantize(palette=colours, dither=Image.Dither.NONE) for picture in joined]
    # The last picture stays for two seconds.
    durations = [round(1000 / PER_SECOND)] * (len(pictures) - 1) + [2000]
    pictures[0].save(path, save_all=True, append_images=pictures[1:], duration=durations, loop=0, optimize=True)
    print(f"{path}: {len(pictures)} pictures, {path.stat().st_size / 1e6:.2f} MB")


def frames(name: str, policy: Policy, x: np.ndarray, normal: Normal | None) -> list[Image.Image]:
    arm, every, path, arrived = Arm(), round(1 / (PER_SECOND * CONTROL)), [], None
    arm.place(x)
    camera = mujoco.MjvCamera()
    camera.lookat[:], camera.distance, camera.azimuth, camera.elevation = [0.33, 0.0, 0.25], 1.3, 140, -25
    pictures = []
    with mujoco.Renderer(arm.model, height=SIZE[1], width=SIZE[0]) as renderer:
        for step in range(round(SECONDS / CONTROL)):
            here = arm.hand
            if arrived is None and np.linalg.norm(here - GOAL) < ARRIVED:
                arrived = step * CONTROL
            if step % every == 0:
                path.append(here)
                renderer.update_scene(arm.data, camera)
                if normal is not None:
                    draw_plane(renderer.scene, x, normal(here))
                for one, another in zip(path, path[1:], strict=False):
                    draw_line(renderer.scene, one, another, COLOURS[name])
                pictures.append(labelled(Image.fromarray(renderer.render()), name, step * CONTROL, arrived))
            velocity = policy(here)
            arm.follow(velocity if normal is None else bound(velocity, normal(here)))
    return pictures


def colour(text: str, alpha: float) -> np.ndarray:
    return np.array([*(int(text[k : k + 2], 16) / 255 for k in (1, 3, 5)), alpha], dtype=np.float32)


def draw_plane(scene: mujoco.MjvScene, at: np.ndarray, normal: np.ndarray) -> None:
    """Draws a thin square, rotated from z to the normal."""
    across = np.linalg.svd(normal[None])[2][1:]
    turn = np.column_stack([*across, np.cross(*across)])
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, mujoco.mjtGeom.mjGEOM_BOX, np.array([0.3, 0.3, 0.001]), at, turn.ravel(), colour("#7a7a7a", 0.25))
    scene.ngeom += 1


def draw_line(scene: mujoco.MjvScene, one: np.ndarray, another: np.ndarray, text: str) -> None:
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, mujoco.mjtGeom.mjGEOM_CAPSULE, np.zeros(3), np.zeros(3), np.eye(3).ravel(), colour(text, 1.0))
    mujoco.mjv_connector(geom, mujoco.mjtGeom.mjGEOM_CAPSULE, 0.007, one, another)
    scene.ngeom += 1


def labelled(picture: Image.Image, name: str, seconds: float, arrived: float | None) -> Image.Image:
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(15)
    draw.text((10, 8), name, fill=COLOURS[name], font=font)
    said = f"{seconds:.1f} s" if arrived is None else f"arrived after {arrived:.1f} s"
    draw.text((10, SIZE[1] - 26), said, fill="#222222", font=font)
    return picture


def side_by_side(parts: tuple[Image.Image, ...]) -> Image.Image:
    width = parts[0].width
    joined = Image.new("RGB", (width * len(parts), SIZE[1]), "white")
    for k, part in enumerate(parts):
        joined.paste(part, (k * width, 0))
    return joined
