"""The single-scattering integral written down plainly: the referee where renderers differ.

Radiance of a camera ray through fog of extinction s(x), from its entry to the first surface or the fog's end:
  integral of T(t) (s albedo phase(cos) E_light(x) V(x) T_light(x) + emission(x)) dt
  + T(end) (emission + color / pi * E_light cos V T_light)
with one random point in each of `STEPS` even steps and one random point of the lights for each of those. Visibility,
distances in homogeneous fog, boxes and balls are exact; in a grid both optical depths are sums over random points of even
steps. Numpy, no code shared with any renderer."""
import math

import numpy as np

import fire
import lights
from grids import bounds_of, density
from phase import phase
from shapes import Occluders, clip

STEPS, LIGHT_STEPS = 64, 24


def unit(v):
    return np.array(v) / np.linalg.norm(v)


def camera_rays(camera, size, random):
    """One ray through a random point of every pixel."""
    forward = unit(np.subtract(camera.target, camera.position))
    right = unit(np.cross(forward, (0, 1, 0)))
    up = np.cross(right, forward)
    width, height = size
    x, y = np.meshgrid(np.arange(width), np.arange(height))
    half = math.tan(math.radians(camera.vertical_fov) / 2)
    u = (2 * (x + random.random(x.shape)) / width - 1) * half * width / height
    v = (1 - 2 * (y + random.random(y.shape)) / height) * half
    direction = (forward + u[..., None] * right + v[..., None] * up).reshape(-1, 3)
    return np.array(camera.position, float), direction / np.linalg.norm(direction, axis=1, keepdims=True)


def thickness(voxels, bounds, points, direction, distance, random):
    """Integral of the density from the points on, over at most `distance`."""
    enter, leave, _ = clip(*bounds, points, direction)
    enter, leave = np.maximum(enter, 0), np.minimum(leave, distance)
    length = np.maximum(leave - enter, 0)
    if voxels is None:
        return length
    total = np.zeros(length.shape)
    for k in range(LIGHT_STEPS):
        t = enter + (k + random.random(length.shape)) / LIGHT_STEPS * length
        total += density(voxels, points + t[..., None] * direction)
    return total * length / LIGHT_STEPS


class Referee:
    """A scene and what its integrals ask for again and again."""

    def __init__(self, scene, voxels, seed):
        self.scene, self.voxels, self.random = scene, voxels, np.random.default_rng(seed)
        self.bounds = bounds_of(scene.fog, voxels)
        self.extinction = np.broadcast_to(np.asarray(scene.fog.extinction, float), 3)
        self.source = lights.source(scene)
        count = scene.size[0] * scene.size[1]
        self.occluders = Occluders(scene.boxes, scene.sphere, self.random.random(count) - 0.5)  # a moment for each ray

    def transmittance(self, points, direction, distance):
        return np.exp(-self.extinction * thickness(self.voxels, self.bounds, points, direction, distance, self.random)[:, None])

    def lit(self, points, which):
        """Direction to a random point of the lights and the irradiance from there over its pdf, on a plane that faces it,
        with shadows of surfaces and fog. `which` of the camera's rays the points are on."""
        to_light, distance, amount = self.source(points, self.random)
        seen = self.occluders.visible(points, to_light, distance, which)
        return to_light, amount * seen[:, None] * self.transmittance(points, to_light, distance)

    def scattered(self, points, direction, which):
        """In-scattered radiance, of albedo 1."""
        if self.scene.fog.recipe and "fire" in self.scene.fog.recipe:
            return fire.scattered(self, points, direction)
        to_light, irradiance = self.lit(points, which)
        return phase(self.scene.fog, (to_light * direction).sum(-1))[:, None] * irradiance


def surfaces(referee, picture, origin, direction, hit, through):
    """Adds what the surfaces that are seen emit and reflect."""
    which = np.flatnonzero(np.isfinite(hit.distance))
    points = origin + hit.distance[which, None] * direction[which] + 1e-6 * hit.normal[which]
    to_light, irradiance = referee.lit(points, which)
    cosine = np.maximum((to_light * hit.normal[which]).sum(-1), 0)[:, None]
    picture[which] += through[which] * (hit.emission[which, None] + hit.color[which] / math.pi * irradiance * cosine)


def render(scene, voxels, seed):
    """One picture [y, x, rgb]."""
    referee = Referee(scene, voxels, seed)
    random, albedo = referee.random, np.array(scene.fog.albedo)
    origin, direction = camera_rays(scene.camera, scene.size, random)
    hit = referee.occluders.first_hit(origin, direction)
    enter, leave, _ = clip(*referee.bounds, origin, direction)
    enter = np.minimum(np.maximum(enter, 0), hit.distance)
    step = np.maximum(np.minimum(leave, hit.distance) - enter, 0) / STEPS
    picture, depth, every = np.zeros((len(direction), 3)), np.zeros(len(direction)), np.arange(len(direction))
    for k in range(STEPS):
        share = random.random(len(direction))
        points = origin + (enter + (k + share) * step)[:, None] * direction
        here = 1 if voxels is None else density(voxels, points)
        through = np.exp(-referee.extinction * (depth + here * share * step)[:, None])
        extinction = referee.extinction * np.broadcast_to(here, len(direction))[:, None]
        inner = extinction * albedo * referee.scattered(points, direction, every)
        picture += through * (inner + fire.emission(scene, voxels, points)) * step[:, None]
        depth += here * step
    through = np.exp(-referee.extinction * depth[:, None])
    surfaces(referee, picture, origin, direction, hit, through)
    picture += through * lights.seen_behind(scene, direction) * ~np.isfinite(hit.distance)[:, None]
    return picture.reshape(scene.size[1], scene.size[0], 3)
