"""Rays against boxes and the moving ball, in closed form."""
import dataclasses

import numpy as np


@dataclasses.dataclass
class Hit:
    """The first surface of each ray: at infinity where there is none."""
    distance: np.ndarray
    normal: np.ndarray
    color: np.ndarray
    emission: np.ndarray


def clip(low, high, origin, direction):
    """Distances where rays enter and leave a box; entry > exit when they miss it. Also the axis of the entry."""
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = (np.array(low) - origin) / direction, (np.array(high) - origin) / direction
    near = np.minimum(a, b)
    return near.max(-1), np.maximum(a, b).min(-1), near.argmax(-1)


class Occluders:
    """Boxes, and a ball that is at center + moment * motion for each of the camera's rays, moments from -1/2 to 1/2."""

    def __init__(self, boxes, sphere, moments):
        self.boxes, self.sphere = boxes, sphere
        if sphere:
            self.centers = np.array(sphere.center) + moments[:, None] * np.array(sphere.motion)

    def ball(self, origin, direction, which):
        """Distance to the ball, infinity where it is missed."""
        offset = self.centers[which] - origin
        along = (offset * direction).sum(-1)
        inside = self.sphere.radius ** 2 - (offset ** 2).sum(-1) + along ** 2
        near = along - np.sqrt(np.maximum(inside, 0))
        return np.where((inside > 0) & (near > 1e-6), near, np.inf)

    def first_hit(self, origin, direction):
        count = len(direction)
        hit = Hit(np.full(count, np.inf), np.zeros((count, 3)), np.zeros((count, 3)), np.zeros(count))
        for box in self.boxes:
            enter, leave, axis = clip(box.low, box.high, origin, direction)
            now = (enter < leave) & (enter > 1e-6) & (enter < hit.distance)
            hit.distance[now], hit.color[now], hit.emission[now] = enter[now], box.color, box.emission
            hit.normal[now] = -np.sign(direction[now]) * np.eye(3)[axis[now]]
        if self.sphere:
            distance = self.ball(origin, direction, np.arange(count))
            now = distance < hit.distance
            hit.distance[now], hit.color[now], hit.emission[now] = distance[now], 0, 0
        return hit

    def visible(self, points, to_light, distance, which):
        """Whether nothing is nearer than the light, but for the last millionth: where lamps are surfaces."""
        seen = np.ones(len(points), bool)
        reach = np.asarray(distance) * (1 - 1e-6)
        for box in self.boxes:
            enter, leave, _ = clip(box.low, box.high, points, to_light)
            seen &= ~((enter < leave) & (leave > 1e-6) & (enter < reach))
        if self.sphere:
            seen &= ~(self.ball(points, to_light, which) < reach)
        return seen
