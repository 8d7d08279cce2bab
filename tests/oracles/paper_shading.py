#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The paper's shading in PyTorch, apart from the program: values and derivatives that its tests are compared with.

paper_shading.py FILE.json           writes random points, light and material, their radiance and its derivatives
paper_shading.py --check FILE.json   1 if FILE says otherwise; 77 where there is no PyTorch

Equations 13 to 15 of the paper under lobes of light, without occlusion. The cosine and its integral over a lobe as
[Meder and Bruederlin 2018]; Fresnel's and the shadowing term as [Karis 2013]; docs/references.md.
"""
import json
import math
import sys

try:
    import torch
except ImportError:
    print("skipped: no PyTorch (Debian: python3-torch)")
    sys.exit(77)

POINTS, LOBES, MIN_COSINE = 12, 5, 0.05


def unit(v):
    return v / v.norm(dim=-1, keepdim=True)


def over_hemisphere(sharpness, cosine):
    t = sharpness.sqrt() * (1.6988 * sharpness**2 + 10.8438 * sharpness) / (sharpness**2 + 6.2201 * sharpness + 10.2415)
    a, b = t.exp(), (t * cosine).exp()
    share = (a * b - 1) / ((a - 1) * (b + 1))
    near = 2 * math.pi / sharpness * (1 - (-sharpness).exp())
    return near * (share + (1 - share) * (-sharpness).exp())


def product(axis1, sharpness1, axis2, sharpness2):
    """Axis, sharpness and peak of the product of two lobes."""
    sum_of_both = sharpness1[..., None] * axis1 + sharpness2[..., None] * axis2
    sharpness = sum_of_both.norm(dim=-1)
    return sum_of_both / sharpness[..., None], sharpness, (sharpness - sharpness1 - sharpness2).exp()


def irradiance(axis, sharpness, normal):
    cosine_lobe = torch.full_like(sharpness, 0.0315)
    both, both_sharpness, peak = product(axis, sharpness, normal, cosine_lobe)
    return 32.7080 * peak * over_hemisphere(both_sharpness, (both * normal).sum(-1)) - 31.7003 * over_hemisphere(
        sharpness, (axis * normal).sum(-1)
    )


def radiance(x):
    """[POINTS, 3]"""
    normal, view = x["normals"], x["views"]
    cosine = (normal * view).sum(-1)
    held = cosine.clamp(min=MIN_COSINE)
    mirror = 2 * cosine[:, None] * normal - view
    pairs = (POINTS, LOBES)
    axis, sharpness = x["axes"].expand(*pairs, 3), x["lambdas"].expand(pairs)
    at = normal[:, None].expand(*pairs, 3)
    lit = irradiance(axis, sharpness, at) @ x["mus"]
    lobe_sharpness = (x["sharpness"] / (4 * held))[:, None].expand(pairs)
    both, both_sharpness, peak = product(axis, sharpness, mirror[:, None].expand(*pairs, 3), lobe_sharpness)
    reflected = (peak * irradiance(both, both_sharpness, at)) @ x["mus"]
    k = (x["roughness"] + 1) ** 2 / 8
    fresnel = x["specular"] + (1 - x["specular"]) * 2 ** ((-5.55473 * held - 6.98316) * held)
    gain = fresnel / (4 * (held * (1 - k) + k) ** 2)
    return x["albedo"] / math.pi * (1 - x["metalness"]) * lit + gain[:, None] * x["amplitude"] * reflected


def sample():
    generator = torch.Generator().manual_seed(5)
    normal = lambda *shape: torch.randn(*shape, generator=generator, dtype=torch.float64)
    share = lambda *shape: torch.rand(*shape, generator=generator, dtype=torch.float64)
    normals = unit(normal(POINTS, 3))
    views = unit(unit(normal(POINTS, 3)) + 1.3 * normals)
    return {
        "normals": normals,
        "views": views,
        "albedo": share(POINTS, 3),
        "axes": unit(normal(LOBES, 3)),
        "lambdas": 1 + 20 * share(LOBES),
        "mus": 0.2 + share(LOBES, 3),
        "sharpness": 20 + 100 * share(1),
        "amplitude": 5 + 10 * share(3),
        "roughness": share(1),
        "specular": share(1),
        "metalness": 0.8 * share(1),
    }


def as_numbers(tensor):
    return [float(f"{v:.9g}") for v in tensor.detach().reshape(-1)]


def oracle():
    x = sample()
    for v in x.values():
        v.requires_grad_(True)
    out = radiance(x)
    weights = torch.linspace(-1, 1, POINTS * 3, dtype=torch.float64).reshape(POINTS, 3)
    (out * weights).sum().backward()
    return {
        "inputs": {name: as_numbers(v) for name, v in x.items()},
        "radiance": as_numbers(out),
        "weights": as_numbers(weights),  # of the radiance in the sum whose derivatives follow
        "derivatives": {name: as_numbers(v.grad) for name, v in x.items()},
    }


def flat(value):
    return [n for v in value.values() for n in flat(v)] if isinstance(value, dict) else value


def main():
    if len(sys.argv) == 3 and sys.argv[1] == "--check":
        stored = flat(json.load(open(sys.argv[2])))
        worst = max(abs(a - b) / (1e-6 + abs(b)) for a, b in zip(stored, flat(oracle()), strict=True))
        print(f"stored and new numbers differ by {worst:.1e} of their value at most")
        return int(worst > 1e-5)
    with open(sys.argv[1], "w") as f:
        json.dump(oracle(), f)
        f.write("\n")
    return 0


sys.exit(main())
