"""Renders a scene with Cycles in a process of its own, through Blender as a Python module: python cycles_peer.py JOB.json
A job is {scene, vdb, orders, samples, threads, seeds, output} or, to turn EXR files into arrays, {exr: [paths]}. It leaves the
picture OUTPUT#.exr and .npy for each seed and the time of its render call, OUTPUT#.seconds: that of a clock, then of
processors."""
import json
import math
import pathlib
import sys
import time
import types

import numpy as np

try:
    import bpy
    import mathutils
except ImportError as missing:
    sys.exit(f"cycles_peer.py: no Blender module: {missing} (pip install bpy==5.0.1; Debian: apt-get install libvulkan1)")

import environment
from mesh import sphere_mesh
from scenes import ALL_ORDERS


def z_up(v):
    return mathutils.Vector((v[0], -v[2], v[1]))


def pixels(path):
    """[y, x, rgb], first row on top (Blender keeps the lowest first)."""
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"  # the numbers as they are
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(image.size[1], image.size[0], image.channels)[::-1, :, :3]
    bpy.data.images.remove(image)
    return values


def empty_tree(owner):
    owner.use_nodes = True
    owner.node_tree.nodes.clear()
    return owner.node_tree


def material(name, shader, inputs, socket):
    """A material of one node."""
    result = bpy.data.materials.new(name)
    tree = empty_tree(result)
    node = tree.nodes.new(shader)
    for key, value in inputs.items():
        node.inputs[key].default_value = value
    tree.links.new(node.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs[socket])
    return result


def surface(box):
    if box.emission:
        return material("lamp", "ShaderNodeEmission", {"Color": (1, 1, 1, 1), "Strength": box.emission}, "Surface")
    return material("box", "ShaderNodeBsdfDiffuse", {"Color": (*box.color, 1)}, "Surface")


def fire_material(fog):
    """Principled Volume: what its color scatters and its temperature emits; black absorption takes the rest. By its own
    Temperature Attribute 5.0.1 shows nothing beside a Density Attribute: a node reads that grid."""
    result = material("fire", "ShaderNodeVolumePrincipled", {
        "Color": (*fog.albedo, 1), "Density": fog.extinction, "Anisotropy": fog.g, "Density Attribute": "density",
        "Absorption Color": (0, 0, 0, 1), "Blackbody Intensity": 1, "Temperature Attribute": ""}, "Volume")
    tree = result.node_tree
    node = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeVolumePrincipled")
    temperature = tree.nodes.new("ShaderNodeAttribute")
    temperature.attribute_name = "temperature"
    tree.links.new(temperature.outputs["Fac"], node.inputs["Temperature"])
    return result


def fog_material(fog, grid):
    extinction, albedo = np.broadcast_to(np.asarray(fog.extinction, float), 3), np.array(fog.albedo)
    coefficients = {"Scatter Coefficients": extinction * albedo, "Absorption Coefficients": extinction * (1 - albedo)}
    result = material("fog", "ShaderNodeVolumeCoefficients", {**coefficients, "Anisotropy": fog.g}, "Volume")
    tree = result.node_tree
    node = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeVolumeCoefficients")
    if fog.alpha:
        node.phase = "DRAINE"
        node.inputs["Alpha"].default_value = fog.alpha
    for name, value in coefficients.items() if grid else ():
        density, scaled = tree.nodes.new("ShaderNodeAttribute"), tree.nodes.new("ShaderNodeVectorMath")
        density.attribute_name = "density"
        scaled.operation = "SCALE"
        scaled.inputs[0].default_value = value
        tree.links.new(density.outputs["Fac"], scaled.inputs["Scale"])
        tree.links.new(scaled.outputs[0], node.inputs[name])
    return result


def add(name, data):
    result = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(result)
    return result


def add_box(low, high, look):
    low, high = z_up(low), z_up(high)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(low + high) / 2)
    bpy.context.object.scale = [abs(c) for c in high - low]
    bpy.context.object.data.materials.append(look)


def add_sphere(sphere):
    """Half way at frame 1; keys at frames 0 and 2, straight in between."""
    points, _, triangles = sphere_mesh(sphere.radius)
    data = bpy.data.meshes.new("sphere")
    data.from_pydata([z_up(p) for p in points], [], triangles.tolist())
    data.materials.append(material("black", "ShaderNodeBsdfDiffuse", {"Color": (0, 0, 0, 1)}, "Surface"))
    ball = add("sphere", data)
    for frame, side in ((0, -1), (2, 1)):
        ball.location = z_up([c + side * m for c, m in zip(sphere.center, sphere.motion)])
        ball.keyframe_insert("location", frame=frame)
    for curve in ball.animation_data.action.layers[0].strips[0].channelbags[0].fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    render = bpy.context.scene.render
    render.use_motion_blur, render.motion_blur_shutter, render.motion_blur_position = True, 1, "CENTER"


def add_fog(fog, vdb):
    if not vdb:
        return add_box(fog.low, fog.high, fog_material(fog, False))
    data = bpy.data.volumes.new("fog")
    data.filepath = vdb
    data.render.clipping = 0  # by default densities below 0.001 are dropped
    data.render.precision = "FULL"
    data.materials.append(fire_material(fog) if getattr(fog.recipe, "fire", None) else fog_material(fog, True))
    add("fog", data).rotation_euler = (math.pi / 2, 0, 0)  # Blender takes the file's axes as they are: Y up becomes Z up here


def add_lamp(light):
    """A point light of P watts has P / (4 pi) watts per steradian, an area light P / (pi area) watts per steradian and
    area; a sun's strength is its irradiance."""
    data = bpy.data.lights.new("light", {"sun": "SUN", "point": "POINT", "rectangle": "AREA"}[light.kind])
    lamp = add("light", data)
    aim = None
    if light.kind == "sun":
        data.energy, data.angle, aim = light.intensity, 0, z_up(light.place)
    elif light.kind == "point":
        data.energy, data.shadow_soft_size = light.intensity * 4 * math.pi, 0
        lamp.location = z_up(light.place)
    else:
        data.shape, (data.size, data.size_y) = "RECTANGLE", light.size
        data.energy = light.intensity * math.pi * light.size[0] * light.size[1]
        lamp.location, aim = z_up(light.place), z_up(light.target) - z_up(light.place)
    if aim:
        lamp.rotation_euler = aim.to_track_quat("-Z", "Y").to_euler()


def world_of(image, strength):
    """Blender's lat-long maps have +X in the middle: a quarter turn brings our -Z there."""
    world = bpy.data.worlds.new("world")
    bpy.context.scene.world = world
    tree = empty_tree(world)
    kinds = ["TexCoord", "Mapping", "TexEnvironment", "Background", "OutputWorld"]
    nodes = [tree.nodes.new("ShaderNode" + kind) for kind in kinds]
    nodes[1].inputs["Rotation"].default_value[2] = -math.pi / 2
    nodes[2].image = image
    nodes[3].inputs["Strength"].default_value = strength
    for source, sink, out, into in ((0, 1, "Generated", "Vector"), (1, 2, 0, 0), (2, 3, 0, 0), (3, 4, 0, 0)):
        tree.links.new(nodes[source].outputs[out], nodes[sink].inputs[into])


def add_camera(camera):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.clip_start, data.clip_end = 1e-3, 1e5
    data.angle = math.radians(camera.vertical_fov)
    eye = add("camera", data)
    eye.location = z_up(camera.position)
    eye.rotation_euler = (z_up(camera.target) - z_up(camera.position)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = eye


def set_up(orders, samples, size, threads):
    """Cycles without its biases: no clamping, no roulette on weak lights, a box filter, unbiased volumes."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.volume_biased = False
    bounces = 128 if orders == ALL_ORDERS else orders - 1
    cycles.max_bounces = cycles.volume_bounces = cycles.diffuse_bounces = bounces
    cycles.min_light_bounces = cycles.min_transparent_bounces = 0
    cycles.transparent_max_bounces = 1024  # the faces around a grid count
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    cycles.pixel_filter_type = "BOX"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = *size, 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.threads_mode, scene.render.threads = "FIXED", threads
    scene.view_settings.view_transform = "Raw"
    scene.frame_set(1)


def build(world, vdb, folder):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.world = None
    for box in world.boxes:
        add_box(box.low, box.high, surface(box))
    if world.sphere:
        add_sphere(world.sphere)
    add_fog(world.fog, vdb)
    if world.light and world.light.kind == "environment":
        environment.write(folder / "environment.hdr")
        world_of(bpy.data.images.load(str(folder / "environment.hdr")), world.light.intensity)
    elif world.light:
        add_lamp(world.light)
    add_camera(world.camera)


def render(seeds, output):
    for seed in seeds:
        bpy.context.scene.cycles.seed = seed
        bpy.context.scene.render.filepath = f"{output}{seed}.exr"
        start, used = time.time(), time.process_time()
        bpy.ops.render.render(write_still=True)
        pathlib.Path(f"{output}{seed}.seconds").write_text(f"{time.time() - start:.3f} {time.process_time() - used:.3f}\n")
        np.save(f"{output}{seed}.npy", pixels(bpy.context.scene.render.filepath))


def main():
    job = json.loads(pathlib.Path(sys.argv[1]).read_text(), object_hook=lambda fields: types.SimpleNamespace(**fields))
    if hasattr(job, "exr"):
        for path in job.exr:
            np.save(pathlib.Path(path).with_suffix(".npy"), pixels(path))
        return
    build(job.scene, job.vdb, pathlib.Path(sys.argv[1]).parent)
    set_up(job.orders, job.samples, job.scene.size, job.threads)
    render(job.seeds, job.output)


if __name__ == "__main__":
    main()
