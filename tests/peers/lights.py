"""Random points of lights for the referee: functions of (points, random) that return the direction there, its distance
and the irradiance [n, rgb] on a plane that faces it, over the pdf of the choice, before anything in the way."""
import math

import numpy as np

import environment


def source(scene):
    light = scene.light
    if light is None:
        lamps = [box for box in scene.boxes if box.emission]
        return (lambda points, random: glowing_box(lamps[0], points, random)) if lamps else dark
    return {"sun": sun, "point": point, "rectangle": rectangle, "environment": sky}[light.kind](light)


def seen_behind(scene, direction):
    """What the camera's rays see behind everything."""
    if scene.light is None or scene.light.kind != "environment":
        return np.zeros((len(direction), 3))
    return scene.light.intensity * environment.radiance(environment.texels(), direction)


def dark(points, random):
    return np.broadcast_to((0.0, 1.0, 0.0), points.shape), np.inf, np.zeros((len(points), 3))


def sun(light):
    way = -np.array(light.place) / np.linalg.norm(light.place)
    return lambda points, random: (np.broadcast_to(way, points.shape), np.inf, np.full((len(points), 3), float(light.intensity)))


def towards(points, places):
    offset = places - points
    distance = np.linalg.norm(offset, axis=-1)
    return offset / distance[:, None], distance


def point(light):
    def sample(points, random):
        to_light, distance = towards(points, np.array(light.place))
        return to_light, distance, np.repeat(light.intensity / distance[:, None] ** 2, 3, 1)
    return sample


def face(points, places, normals, radiance, area):
    """From places evenly over an area."""
    to_light, distance = towards(points, places)
    cosine = np.maximum(-(to_light * normals).sum(-1), 0)
    return to_light, distance, np.repeat((radiance * area * cosine / distance ** 2)[:, None], 3, 1)


def rectangle(light):
    normal = np.subtract(light.target, light.place) / np.linalg.norm(np.subtract(light.target, light.place))
    across = np.cross(normal, (0, 1, 0))
    across /= np.linalg.norm(across)
    upward, (width, height) = np.cross(across, normal), light.size

    def sample(points, random):
        u, v = random.random((2, len(points), 1)) - 0.5
        return face(points, np.array(light.place) + u * width * across + v * height * upward, normal, light.intensity,
                    width * height)
    return sample


def glowing_box(box, points, random):
    """One of its six faces in proportion to their areas, evenly over that."""
    edges = np.subtract(box.high, box.low)
    areas = np.prod(edges) / edges
    axis, side = random.choice(3, len(points), p=areas / areas.sum()), random.integers(0, 2, len(points))
    places = np.array(box.low) + random.random((len(points), 3)) * edges
    every = np.arange(len(points))
    places[every, axis] = np.where(side, np.array(box.high)[axis], np.array(box.low)[axis])
    normals = np.zeros_like(places)
    normals[every, axis] = 2 * side - 1
    return face(points, places, normals, box.emission, 2 * areas.sum())


def sky(light):
    """Half of the directions evenly, half as the map's glow is: exp(SHARPNESS (cosine - 1)) about it."""
    image, k = environment.texels(), environment.SHARPNESS
    axis = environment.GLOW
    side = np.cross(axis, (0, 1, 0)) / np.linalg.norm(np.cross(axis, (0, 1, 0)))
    third = np.cross(axis, side)

    def sample(points, random):
        u, angle = random.random(len(points)), 2 * math.pi * random.random(len(points))
        glow = 1 + np.log(u + (1 - u) * math.exp(-2 * k)) / k
        cosine = np.where(random.random(len(points)) < 0.5, glow, 2 * u - 1)
        sine = np.sqrt(np.maximum(1 - cosine ** 2, 0))
        d = cosine[:, None] * axis + (sine * np.cos(angle))[:, None] * side + (sine * np.sin(angle))[:, None] * third
        pdf = 0.5 / (4 * math.pi) + 0.5 * k / (2 * math.pi * (1 - math.exp(-2 * k))) * np.exp(k * (cosine - 1))
        return d, np.inf, light.intensity * environment.radiance(image, d) / pdf[:, None]
    return sample
