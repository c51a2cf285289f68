#!/usr/bin/env python3
"""Estimators of policies under constraints A u = b, implemented from their formulas in NumPy alone.

    DPL    u = pi(x): least squares on the observations
    SVD    A of each movement from A u = 0: the least singular vectors of its velocities; then least squares on |N (pi(x) - u)|^2
    GSVD   A and b of each movement from A u = b with |A| = 1; then the same least squares
    CCL    least squares on (u'pi(x)/|u| - |u|)^2

(DPL, SVD, GSVD: Armesto, Moura, Ivan, Salas, Vijayakumar 2017, and with Erden 2018; CCL: Howard, Klanke, Gienger, Goerick, Vijayakumar 2009, and
its unit normal: Lin, Howard, Vijayakumar 2015.)  All policies are pi(x) = W phi(x), locally weighted linear models with normalised Gaussians
about the centres of k-means. Each estimator's own loss on held-out movements selects their number, their width and the ridge.

A movement is a dict: x (N, n), u (N, n) and, if the estimator receives the kinematics of an arm, J (N, m, n) and z (N, p):
A = W_A J and b = W_b z. Without them A and b are constant.

usage: constraints.py --self-test
"""
import sys
import numpy as np

CENTRES = {2: (10, 25, 50), 7: (1, 6, 12)}
WIDTHS = (0.7, 1.0, 1.5)  # in units of the distance to the nearest other centre
RIDGES = (1e-10, 1e-7, 1e-4, 1e-2)


# Policies ------------------------------------------------------------------------------------------------------------

def k_means(x, count, rng, rounds=30):
    centres = x[rng.choice(len(x), count, replace=False)]
    for _ in range(rounds):
        nearest = squared_distances(x, centres).argmin(1)
        centres = np.array([x[nearest == k].mean(0) if np.any(nearest == k) else centres[k] for k in range(count)])
    return centres


def squared_distances(x, centres):
    return ((x[:, None, :] - centres[None]) ** 2).sum(2)


class Features:
    """phi(x) = [w_m(x) (x - c_m)/s, w_m(x)] for all m, with w normalised Gaussians and s the width."""

    def __init__(self, x, count, width, rng):
        self.centres = k_means(x, count, rng)
        if count == 1:
            self.scale = np.sqrt(((x - self.centres) ** 2).sum(1).mean())
            return
        apart = squared_distances(self.centres, self.centres) + np.diag(np.full(count, np.inf))
        self.scale = width * np.sqrt(apart.min(1)).mean()

    def __call__(self, x):
        exponents = -0.5 * squared_distances(x, self.centres) / self.scale ** 2
        weights = np.exp(exponents - exponents.max(1, keepdims=True))  # far from all centres, only the nearest one counts
        weights /= weights.sum(1, keepdims=True)
        local = np.concatenate([(x[:, None, :] - self.centres) / self.scale, np.ones((len(x), len(self.centres), 1))], 2)
        return (weights[:, :, None] * local).reshape(len(x), -1)


def normal_equations(phi, weights, u):
    """Normal equations for the least sum |P (W'phi - u)|^2 over W (features, n), column by column; P'P = weights (N, n, n)."""
    n, count = u.shape[1], phi.shape[1]
    matrix = np.empty((n, count, n, count))
    for a in range(n):
        for b in range(a, n):
            matrix[a, :, b, :] = phi.T @ (phi * weights[:, a, b][:, None])
            matrix[b, :, a, :] = matrix[a, :, b, :].T
    right = np.einsum("if,iab,ib->af", phi, weights, u)
    return matrix.reshape(n * count, n * count), right.ravel()


class LeastSquares:
    """One weighted regression, solved for all ridges with one eigendecomposition."""

    def __init__(self, phi, weights, u):
        self.shape = (u.shape[1], phi.shape[1])
        matrix, right = normal_equations(phi, weights, u)
        self.values, self.vectors = np.linalg.eigh(matrix)
        self.right = self.vectors.T @ right

    def solve(self, ridge):
        solved = self.right / (np.maximum(self.values, 0) + ridge * self.values[-1])
        return (self.vectors @ solved).reshape(self.shape).T


def loss(policy, x, u, weights):
    errors = policy(x) - u
    return np.einsum("ia,iab,ib->", errors, weights, errors)


def fit(movements, weigh, seed=0):
    """The least-squares policy with weights weigh(movement) (N, n, n); every fifth movement is held out to select its form."""
    weights = [weigh(movement) for movement in movements]
    together = lambda chosen: tuple(np.concatenate(parts) for parts in zip(
        *[(movements[k]["x"], movements[k]["u"], weights[k]) for k in chosen]))
    x, u, p = together([k for k in range(len(movements)) if k % 5])
    held = together(range(0, len(movements), 5))
    best = (np.inf,)
    for count in CENTRES[x.shape[1]]:
        for width in WIDTHS[:1] if count == 1 else WIDTHS:
            features = Features(x, count, width, np.random.default_rng(seed))
            phi = features(x)
            regression = LeastSquares(phi, p, u)
            for ridge in RIDGES:
                solved = regression.solve(ridge)
                error = loss(lambda at: features(at) @ solved, *held)
                if error < best[0]:
                    best = (error, count, width, ridge)
    _, count, width, ridge = best
    x, u, p = together(range(len(movements)))
    features = Features(x, count, width, np.random.default_rng(seed))
    solved = LeastSquares(features(x), p, u).solve(ridge)
    return lambda at: features(at) @ solved


# Constraints ---------------------------------------------------------------------------------------------------------

def least_singular_vectors(rows, rank):
    """The `rank` orthonormal vectors v (rank, m) with the least |rows v|."""
    return np.linalg.svd(rows, full_matrices=True)[2][-rank:]


def unit_normal(u):
    """CCL's unit normal of a movement, with the least sum (n'u)^2."""
    return least_singular_vectors(u, 1)[0]


def given(movement):
    """J u (N, m), on which W_A acts; u itself without J."""
    return np.einsum("imn,in->im", movement["J"], movement["u"]) if "J" in movement else movement["u"]


def svd_constraint(movement, rank):
    """W_A of A u = 0."""
    return least_singular_vectors(given(movement), rank)


def gsvd_constraint(movement, rank):
    """W_A and W_b of A u = b: [W_A, -W_b][J u; z] = 0 with |W_A| = 1. For any W_A, W_b is the least-squares
    solution, so W_A has the least singular vectors of the residual of J u given z; z = 1 gives centred velocities."""
    moved, z = given(movement), np.c_[np.ones(len(movement["u"])), movement.get("z", np.empty((len(movement["u"]), 0)))]
    explained = np.linalg.lstsq(z, moved, rcond=None)[0]
    normals = least_singular_vectors(moved - z @ explained, rank)
    return normals, normals @ explained.T


def projectors(movement, normals):
    """N = I - A+ A at every sample, (N, n, n)."""
    n, count = movement["u"].shape[1], len(movement["u"])
    rows = normals @ movement["J"] if "J" in movement else np.broadcast_to(normals, (count,) + normals.shape)
    return np.eye(n) - np.linalg.pinv(rows, rcond=1e-10) @ rows


# Estimators ----------------------------------------------------------------------------------------------------------

def dpl(movements, rank):
    n = movements[0]["u"].shape[1]
    return fit(movements, lambda movement: np.broadcast_to(np.eye(n), (len(movement["u"]), n, n)))


def svd(movements, rank):
    return fit(movements, lambda movement: projectors(movement, svd_constraint(movement, rank)))


def gsvd(movements, rank):
    return fit(movements, lambda movement: projectors(movement, gsvd_constraint(movement, rank)[0]))


def ccl(movements, rank):
    def along(movement):
        lengths = np.maximum(np.linalg.norm(movement["u"], axis=1, keepdims=True), 1e-300)
        unit = movement["u"] / lengths
        return unit[:, :, None] * unit[:, None, :]
    return fit(movements, along)


ESTIMATORS = {"DPL": dpl, "SVD": svd, "GSVD": gsvd, "CCL": ccl}


def nupe(policy, x, truth):
    return ((policy(x) - truth) ** 2).sum() / ((truth - truth.mean(0)) ** 2).sum()


# Self-test -----------------------------------------------------------------------------------------------------------

def self_test():
    rng = np.random.default_rng(1)
    truth = rng.standard_normal((2, 2))
    policy = lambda x: x @ truth.T + 0.3

    def movements(pushed, constrained=True, count=30):
        made = []
        for _ in range(count):
            x, a = rng.standard_normal((40, 2)), rng.standard_normal(2)
            a /= np.linalg.norm(a)
            b = pushed * rng.uniform(-1, 1)
            u = policy(x)
            made.append({"x": x, "u": u - np.outer(u @ a - b, a) if constrained else u, "a": a, "b": b})
        return made
    fresh = rng.standard_normal((200, 2))
    error = lambda estimator, data: nupe(estimator(data, 1), fresh, policy(fresh))
    free, still, pushed = movements(0, False), movements(0), movements(0.5)
    exact = {
        "DPL, free movement": error(dpl, free),
        "SVD, b = 0": error(svd, still),
        "GSVD, b = 0": error(gsvd, still),
        "GSVD, b != 0": error(gsvd, pushed),
        "CCL, b = 0": error(ccl, still),
        "unit normal": max(1 - abs(unit_normal(m["u"]) @ m["a"]) for m in still),
        "normal, b != 0": max(1 - abs(gsvd_constraint(m, 1)[0][0] @ m["a"]) for m in pushed),
        "b": max(abs(abs(gsvd_constraint(m, 1)[1][0, 0]) - abs(m["b"])) for m in pushed),
        "A = W J, b = W z": with_kinematics(rng),
    }
    wrong = {"DPL, constrained": error(dpl, still), "SVD, b != 0": error(svd, pushed), "CCL, b != 0": error(ccl, pushed)}
    for name, value in {**exact, **wrong}.items():
        print(f"{name:22s}{value:10.1e}")
    failed = [name for name, value in exact.items() if not value < 1e-8] + [name for name, value in wrong.items() if not value > 1e-3]
    sys.exit(f"failed: {', '.join(failed)}" if failed else 0)


def with_kinematics(rng):
    """1 - |cosine| of the angle between the estimated and the true W_A, where J and z change along the movement."""
    jacobians, z, weights = rng.standard_normal((60, 3, 4)), rng.standard_normal((60, 2)), rng.standard_normal((1, 3))
    task, rows = z @ rng.standard_normal(2) + 0.7, (weights @ jacobians)[:, 0]
    u = rng.standard_normal((60, 4))
    u += rows * ((task - (u * rows).sum(1)) / (rows ** 2).sum(1))[:, None]
    found = gsvd_constraint({"u": u, "J": jacobians, "z": z}, 1)[0][0]
    return 1 - abs(found @ weights[0]) / np.linalg.norm(weights)


if __name__ == "__main__":
    if sys.argv[1:] != ["--self-test"]:
        sys.exit(__doc__)
    self_test()
