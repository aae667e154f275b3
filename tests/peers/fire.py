"""Glowing fog for the referee: Blender's Principled Volume at Blackbody Intensity 1, per meter and whatever the density:
5.670373e-8 T^4 1e-6 / pi times a color of luminance 1."""
import math

import numpy as np

from blackbody import color
from grids import density
from phase import phase
from shapes import clip

STEPS = 32  # along a ray that looks for light


def glow(kelvin):
    """Radiance per meter [..., rgb]."""
    return (5.670373e-8 * 1e-6 / math.pi * kelvin ** 4)[..., None] * color(kelvin)


def emission(scene, voxels, points):
    """Of the temperature between voxels or, where `emission_of_voxels` has been asked for, between what voxels emit."""
    if not scene.fog.recipe or "fire" not in scene.fog.recipe:
        return 0
    if "emission 0" in voxels:
        return np.stack([density(voxels, points, f"emission {c}") for c in range(3)], -1)
    return glow(density(voxels, points, "temperature"))


def emission_of_voxels(voxels):
    """As Cycles 5 has it, which picks one of the voxels around a point by chance."""
    return voxels | {f"emission {c}": part for c, part in enumerate(np.moveaxis(glow(voxels["temperature"]), -1, 0))}


def scattered(referee, points, direction):
    """In-scattered radiance, of albedo 1: what arrives along one direction, anywhere on the sphere."""
    random, voxels, scene = referee.random, referee.voxels, referee.scene
    cosine, angle = 2 * random.random(len(points)) - 1, 2 * math.pi * random.random(len(points))
    sine = np.sqrt(1 - cosine ** 2)
    to_light = np.stack([sine * np.cos(angle), cosine, sine * np.sin(angle)], -1)
    _, leave, _ = clip(*referee.bounds, points, to_light)
    step = np.maximum(leave, 0) / STEPS
    arriving, depth = np.zeros((len(points), 3)), np.zeros(len(points))
    for k in range(STEPS):
        share = random.random(len(points))
        there = points + ((k + share) * step)[:, None] * to_light
        here = density(voxels, there)
        through = np.exp(-referee.extinction * (depth + here * share * step)[:, None])
        arriving += through * emission(scene, voxels, there) * step[:, None]
        depth += here * step
    return 4 * math.pi * phase(scene.fog, (to_light * direction).sum(-1))[:, None] * arriving
