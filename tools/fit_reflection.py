#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the reflection lobes of core/math/reflection_axis.h to the light that GGX surfaces reflect, and prints
core/math/reflection_pairs.cpp. Needs NumPy and SciPy; takes a minute.

Every node of the tables is a cosine of normal and viewer and a roughness. There the density of the reflected
light over directions is known; the lobe's axis, roughness and stretch are those of the least squared error of
the density, plus twice that of the density blurred by 17 degrees, so that energy far from the peak counts."""
import numpy as np
from scipy.optimize import least_squares

COSINES, ROUGHNESSES = 32, 24  # as in core/math/pair_table.h
MIN_COSINE, MIN_ROUGHNESS = 1e-3, 0.05
# As in core/math/reflection.h.
NODES = np.array([0.0073650, 0.0354975, 0.1154150, 0.3714659, 1.3242071])
SHARES = np.array([0.0267184, 0.0805499, 0.1724400, 0.5452267, 0.1750652])
# Above these cosines the mirror direction is too near the normal to tell the axis by it.
FRONTAL = {"base": 0.999, "fresnel": 0.85}
BLUR = 1 / np.radians(17) ** 2  # sharpness of a spherical Gaussian
LOW, HIGH = [-0.5, 0.3, 1.0], [0.95, 2.5, 4.0]  # of share of the normal, roughness over the surface's, stretch


def sharpnesses(roughness):
    """Of the five Gaussians: reflection_shape()."""
    alpha = roughness ** 2
    peaked = 1 / (1 + (alpha / 0.31627) ** 6)
    return ((0.33878 + 0.79402 * peaked) / alpha ** 2 + 1.59705) * NODES ** (1.0693 * peaked)


def fresnel_rise(cosine):
    """core/math/brdf.h, fresnel() of F0 = 0."""
    g = np.sqrt(cosine ** 2 + 1.25)
    p = (cosine * (g + cosine) - 1) / (cosine * (g - cosine) + 1)
    return (0.5 * ((g - cosine) / (g + cosine)) ** 2 * (1 + p ** 2) * 25 - 1) / 24


def smith(cosine, alpha):
    return 2 * cosine / (cosine + np.sqrt(alpha ** 2 + (1 - alpha ** 2) * cosine ** 2))


def directions(axis, side, smallest):
    """Polar grid about an axis in the plane y = 0, for y > 0, with the solid angles of both halves."""
    edges = np.concatenate([[0], np.geomspace(smallest, np.pi, 73)])
    radius, d_radius = (edges[1:] + edges[:-1]) / 2, np.diff(edges)
    angle = np.pi * (np.arange(32) + 0.5) / 32
    r, a = (x.ravel() for x in np.meshgrid(radius, angle, indexing="ij"))
    across = np.array([0, 1, 0])
    d = np.outer(np.cos(r), axis) + np.outer(np.sin(r) * np.cos(a), side) + np.outer(np.sin(r) * np.sin(a), across)
    return d, np.sin(r) * np.repeat(d_radius, 32) * 2 * np.pi / 32


def sphere_half(count):
    """Fibonacci directions with y > 0."""
    i = np.arange(2 * count)
    y, a = 1 - (i + 0.5) / count, np.pi * (3 - np.sqrt(5)) * i
    r = np.sqrt(1 - y ** 2)
    return np.stack([r * np.cos(a), y, r * np.sin(a)], 1)[:count]


SEEN = sphere_half(200)


def blur_matrix(d, weight):
    """From densities at d, and at d mirrored, to blurred ones at SEEN."""
    norm = BLUR / (2 * np.pi)
    flipped = d * [1, -1, 1]
    return (np.exp(BLUR * (SEEN @ d.T - 1)) + np.exp(BLUR * (SEEN @ flipped.T - 1))) * (norm * weight / 2)


def true_density(part, d, view, roughness):
    alpha, cosine = roughness ** 2, d[:, 2]
    half = d + view
    half /= np.maximum(np.linalg.norm(half, axis=1, keepdims=True), 1e-9)
    vh = np.clip(half @ view, 0, 1)
    ggx = (alpha / (half[:, 2] ** 2 * (alpha ** 2 - 1) + 1)) ** 2
    rise = fresnel_rise(vh)
    density = ggx * smith(np.maximum(cosine, 1e-9), alpha) * (1 - rise if part == "base" else rise)
    return np.where(cosine > 0, density, 0)


def lobe_density(axis, d, roughness, stretch):
    sharpness = sharpnesses(roughness)[:, None]
    weight = SHARES[:, None] * sharpness / (2 * np.pi * (1 - np.exp(-2 * sharpness)))
    gap = d - axis
    across = gap[:, 1] ** 2
    along = np.sum(gap ** 2, 1) - across
    return np.sum(weight * np.exp(-sharpness / 2 * (along / stretch + across * stretch)), 0)


class Node:
    """The reflection at one cosine and roughness."""

    def __init__(self, part, cosine, roughness):
        sine = np.sqrt(1 - cosine ** 2)
        self.roughness, self.mirror = roughness, np.array([-sine, 0, cosine])
        self.d, solid_angle = directions(self.mirror, np.array([cosine, 0, sine]), 0.1 * roughness ** 2)
        self.blur = blur_matrix(self.d, solid_angle)
        truth = true_density(part, self.d, np.array([sine, 0, cosine]), roughness)
        self.truth = truth / np.sum(truth * solid_angle)
        blurred = self.blur @ self.truth
        self.scale = np.sqrt(solid_angle / np.sum(solid_angle * self.truth ** 2))
        self.blurred_scale = np.sqrt(2 / np.sum(blurred ** 2))

    def residual(self, share, ratio, stretch):
        axis = self.mirror * (1 - share) + np.array([0, 0, 1]) * share
        gap = lobe_density(axis / np.linalg.norm(axis), self.d, self.roughness * ratio, stretch) - self.truth
        return np.concatenate([self.scale * gap, self.blurred_scale * (self.blur @ gap)])


def fit(node, start):
    """Share, ratio and stretch, and the ratio of a round lobe about the same axis."""
    pull = 1e-3  # towards the neighbor, where the density hardly tells
    best = least_squares(lambda p: np.concatenate([node.residual(*p), pull * (p - start)]),
                         np.clip(start, np.add(LOW, 1e-6), np.subtract(HIGH, 1e-6)), bounds=(LOW, HIGH)).x
    round_ratio = least_squares(lambda p: node.residual(best[0], p[0], 1.0), [min(best[1], 2.4)],
                                bounds=([LOW[1]], [HIGH[1]])).x[0]
    return best, round_ratio


def tables(part):
    axis, stretched = np.zeros((ROUGHNESSES, COSINES, 2)), np.zeros((ROUGHNESSES, COSINES, 2))
    for row in range(ROUGHNESSES):
        roughness = MIN_ROUGHNESS + (1 - MIN_ROUGHNESS) * row / (ROUGHNESSES - 1)
        start = np.array([0.0, 1.0, 1.01])
        for column in reversed(range(COSINES)):
            cosine = min(max(column / (COSINES - 1), MIN_COSINE), FRONTAL[part])
            start, round_ratio = fit(Node(part, cosine, roughness), start)
            axis[row, column] = start[0], round_ratio
            stretched[row, column] = start[1], start[2]
    return axis, stretched


def print_table(name, table):
    numbers = [f"{x:.5g}f" for x in table.ravel()]
    numbers = [n if "." in n or "e" in n else n.replace("f", ".0f") for n in numbers]
    print(f"constexpr FittedPairs {name} = {{")
    for i in range(0, len(numbers), 8):
        print("    " + ", ".join(numbers[i:i + 8]) + ",")
    print("};")


def main():
    print("// SPDX-License-Identifier: Apache-2.0\n// Printed by tools/fit_reflection.py.")
    print('#include "core/math/reflection_pairs.h"\n\nnamespace cei3d {\nnamespace {\n\n// clang-format off')
    for part in ("base", "fresnel"):
        for kind, table in zip(("Axis", "Stretch"), tables(part)):
            print_table(f"k{part.capitalize()}{kind}", table)
    print("// clang-format on\n\n}  // namespace\n")
    print("ReflectionPairs reflection_pairs(ReflectionPart part) {")
    print("  if (part == ReflectionPart::base) return {kBaseAxis, kBaseStretch};")
    print("  return {kFresnelAxis, kFresnelStretch};\n}\n\n}  // namespace cei3d")


if __name__ == "__main__":
    main()
