"""The single-scattering integral written down plainly: the referee where renderers differ.

Radiance of a camera ray through fog of extinction s(x), from its entry to the first surface or the fog's end:
  integral of T(t) s albedo phase(cos) E_light(x) V(x) T_light(x) dt  +  T(end) color / pi * E_light cos V T_light
with one random point in each of `STEPS` even steps. Visibility, distances in homogeneous fog and boxes are exact; in a grid
both optical depths are sums over random points of even steps. Numpy, no code shared with any renderer."""
import math

import numpy as np

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


def clip(low, high, origin, direction):
    """Distances where rays enter and leave a box; entry > exit when they miss it. Also the axis of the entry."""
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = (np.array(low) - origin) / direction, (np.array(high) - origin) / direction
    near = np.minimum(a, b)
    return near.max(-1), np.maximum(a, b).min(-1), near.argmax(-1)


def first_hit(boxes, origin, direction):
    """Distance, normal and color of the first surface; infinity where there is none."""
    distance = np.full(len(direction), np.inf)
    normal, color = np.zeros_like(direction), np.zeros_like(direction)
    for box in boxes:
        enter, leave, axis = clip(box.low, box.high, origin, direction)
        hit = (enter < leave) & (enter > 1e-6) & (enter < distance)
        distance[hit] = enter[hit]
        normal[hit] = -np.sign(direction[hit]) * np.eye(3)[axis[hit]]
        color[hit] = box.color
    return distance, normal, color


def arriving(light, points):
    """Direction to the light, distance, irradiance on a plane that faces it, before anything in the way."""
    if light.kind == "sun":
        return np.broadcast_to(-unit(light.place), points.shape), np.inf, light.intensity
    offset = np.array(light.place) - points
    distance = np.linalg.norm(offset, axis=-1)
    return offset / distance[..., None], distance, light.intensity / distance ** 2


def visible(boxes, points, to_light, distance):
    seen = np.ones(points.shape[:-1], bool)
    for box in boxes:
        enter, leave, _ = clip(box.low, box.high, points, to_light)
        seen &= ~((enter < leave) & (leave > 1e-6) & (enter < distance))
    return seen


def density(voxels, points):
    """Trilinear between voxel centres, 0 outside."""
    first, size, values = voxels
    padded = np.pad(values, 1)
    place = np.clip((points - first) / size + 1, 0, np.array(padded.shape) - 1.001)
    cell = place.astype(np.int64)
    part = place - cell
    strides = np.array(padded.strides) // padded.itemsize
    flat, index = padded.ravel(), cell @ strides
    at = [[flat[index + (x * strides[0] + y * strides[1])], flat[index + (x * strides[0] + y * strides[1] + 1)]]
          for x in (0, 1) for y in (0, 1)]
    rows = [a + part[:, 2] * (b - a) for a, b in at]
    planes = [rows[2 * x] + part[:, 1] * (rows[2 * x + 1] - rows[2 * x]) for x in (0, 1)]
    return planes[0] + part[:, 0] * (planes[1] - planes[0])


def bounds_of(fog, voxels):
    if voxels is None:
        return fog.low, fog.high
    first, size, values = voxels
    return first - size, first + np.array(values.shape) * size


def light_depth(fog, voxels, bounds, points, to_light, distance, random):
    """Optical depth from the points to the light."""
    enter, leave, _ = clip(*bounds, points, to_light)
    enter, leave = np.maximum(enter, 0), np.minimum(leave, distance)
    length = np.maximum(leave - enter, 0)
    if voxels is None:
        return fog.extinction * length
    depth = np.zeros(length.shape)
    for k in range(LIGHT_STEPS):
        t = enter + (k + random.random(length.shape)) / LIGHT_STEPS * length
        depth += density(voxels, points + t[..., None] * to_light)
    return fog.extinction * depth * length / LIGHT_STEPS


def lit(scene, voxels, bounds, points, random):
    """Direction to the light and irradiance there, with shadows of boxes and fog."""
    to_light, distance, amount = arriving(scene.light, points)
    depth = light_depth(scene.fog, voxels, bounds, points, to_light, distance, random)
    return to_light, amount * visible(scene.boxes, points, to_light, distance) * np.exp(-depth)


def phase(g, cosine):
    return (1 - g * g) / (4 * math.pi * (1 + g * g - 2 * g * cosine) ** 1.5)


def render(scene, voxels, seed):
    """One picture [y, x, rgb]."""
    random = np.random.default_rng(seed)
    fog, bounds = scene.fog, bounds_of(scene.fog, voxels)
    origin, direction = camera_rays(scene.camera, scene.size, random)
    surface, normal, color = first_hit(scene.boxes, origin, direction)
    enter, leave, _ = clip(*bounds, origin, direction)
    enter = np.minimum(np.maximum(enter, 0), surface)
    step = np.maximum(np.minimum(leave, surface) - enter, 0) / STEPS
    radiance, depth = np.zeros(len(direction)), np.zeros(len(direction))
    for k in range(STEPS):
        share = random.random(len(direction))
        points = origin + (enter + (k + share) * step)[:, None] * direction
        extinction = fog.extinction * (1 if voxels is None else density(voxels, points))
        to_light, irradiance = lit(scene, voxels, bounds, points, random)
        scattered = phase(fog.g, (to_light * direction).sum(-1)) * irradiance
        radiance += np.exp(-depth - extinction * share * step) * extinction * step * scattered
        depth += extinction * step
    picture = radiance[:, None] * np.array(fog.albedo)
    hit = np.isfinite(surface)
    points = origin + surface[hit, None] * direction[hit]
    to_light, irradiance = lit(scene, voxels, bounds, points, random)
    cosine = np.maximum((to_light * normal[hit]).sum(-1), 0)
    picture[hit] += color[hit] / math.pi * (np.exp(-depth[hit]) * irradiance * cosine)[:, None]
    return picture.reshape(scene.size[1], scene.size[0], 3)
