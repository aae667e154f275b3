"""Triangles of boxes and balls: (points, normals, triangles [n, 3])."""
import numpy as np

FACES = [(4, 5, 7, 6), (1, 0, 2, 3), (5, 1, 3, 7), (0, 4, 6, 2), (6, 7, 3, 2), (0, 1, 5, 4)]  # +z -z +x -x +y -y
NORMALS = [(0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)]
SEGMENTS, RINGS = 128, 64  # of a ball: 0.1 % less cross section than a true one


def box_mesh(boxes):
    points, normals, triangles = [], [], []
    for box in boxes:
        for face, normal in zip(FACES, NORMALS):
            first = len(points)
            points += [tuple((box.high if corner >> axis & 1 else box.low)[axis] for axis in range(3)) for corner in face]
            normals += [normal] * 4
            triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return np.array(points), np.array(normals), np.array(triangles)


def sphere_mesh(radius):
    """Around the origin."""
    theta, phi = np.meshgrid(np.linspace(0, np.pi, RINGS + 1), np.linspace(0, 2 * np.pi, SEGMENTS + 1), indexing="ij")
    normals = np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), np.sin(theta) * np.cos(phi)], -1).reshape(-1, 3)
    row, column = (part.reshape(-1) for part in np.meshgrid(np.arange(RINGS), np.arange(SEGMENTS), indexing="ij"))
    a = row * (SEGMENTS + 1) + column
    b = a + SEGMENTS + 1
    triangles = np.concatenate([np.stack([a, b, b + 1], -1), np.stack([a, b + 1, a + 1], -1)])
    return radius * normals, normals, triangles
