"""Runs inside Blender: blender -b --factory-startup --python-exit-code 3 -P cycles_peer.py -- JOB.json
A job renders a scene with Cycles ({scene, vdb, voxel_size, orders, samples, step_rate, seeds, output}: the picture
OUTPUT#.exr and .npy per seed, and OUTPUT#.seconds) or turns EXR files into arrays ({exr: [paths]}: a .npy beside each)."""
import json
import math
import pathlib
import sys
import time
import types

try:
    import bpy
    import mathutils
except ImportError:
    sys.exit("cycles_peer.py: run it in Blender: blender -b --factory-startup -P cycles_peer.py -- JOB.json")
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from scenes import ALL_ORDERS  # noqa: E402


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


def material(name, *shaders, socket):
    """A material whose `socket` is the sum of the shaders, each (node type, {input: value})."""
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    tree = result.node_tree
    tree.nodes.clear()
    outputs = []
    for kind, inputs in shaders:
        node = tree.nodes.new(kind)
        for key, value in inputs.items():
            node.inputs[key].default_value = value
        outputs.append(node.outputs[0])
    while len(outputs) > 1:
        add = tree.nodes.new("ShaderNodeAddShader")
        tree.links.new(outputs.pop(), add.inputs[0])
        tree.links.new(outputs.pop(), add.inputs[1])
        outputs.append(add.outputs[0])
    tree.links.new(outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs[socket])
    return result


def fog_material(fog, grid):
    """Scattering albedo * extinction and absorption (1 - albedo) * extinction: Cycles' two shaders share a colour."""
    color = (*fog.albedo, 1)
    result = material("fog", ("ShaderNodeVolumeScatter", {"Color": color, "Density": fog.extinction,
                                                           "Anisotropy": fog.g}),
                      ("ShaderNodeVolumeAbsorption", {"Color": color, "Density": fog.extinction}), socket="Volume")
    if grid:
        tree = result.node_tree
        density, scaled = tree.nodes.new("ShaderNodeAttribute"), tree.nodes.new("ShaderNodeMath")
        density.attribute_name = "density"
        scaled.operation = "MULTIPLY"
        scaled.inputs[1].default_value = fog.extinction
        tree.links.new(density.outputs["Fac"], scaled.inputs[0])
        for node in list(tree.nodes):
            if "Density" in node.inputs:
                tree.links.new(scaled.outputs[0], node.inputs["Density"])
    return result


def add_box(low, high, surface):
    low, high = z_up(low), z_up(high)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(low + high) / 2)
    bpy.context.object.scale = [abs(c) for c in high - low]
    bpy.context.object.data.materials.append(surface)


def add_fog(fog, vdb, voxel_size):
    """Cycles 3.4 shows a grid half a voxel too far along each of its axes (README.md): it is moved back."""
    if not vdb:
        return add_box(fog.low, fog.high, fog_material(fog, False))
    bpy.ops.object.volume_import(filepath=vdb)
    volume = bpy.context.object
    volume.rotation_euler = (math.pi / 2, 0, 0)  # Blender takes the file's axes as they are: Y up becomes Z up here
    volume.location = z_up([-voxel_size / 2] * 3)
    volume.data.render.clipping = 0              # by default densities below 0.001 are dropped
    volume.data.render.precision = "FULL"
    volume.data.materials.append(fog_material(fog, True))


def add_light(light):
    """A point light of P watts has P / (4 pi) watts per steradian; a sun's strength is its irradiance."""
    sun = light.kind == "sun"
    data = bpy.data.lights.new("light", "SUN" if sun else "POINT")
    data.energy = light.intensity if sun else light.intensity * 4 * math.pi
    lamp = bpy.data.objects.new("light", data)
    if sun:
        data.angle = 0
        lamp.rotation_euler = z_up(light.place).to_track_quat("-Z", "Y").to_euler()
    else:
        data.shadow_soft_size = 0
        lamp.location = z_up(light.place)
    bpy.context.collection.objects.link(lamp)


def add_camera(camera):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.angle = math.radians(camera.vertical_fov)
    eye = bpy.data.objects.new("camera", data)
    eye.location = z_up(camera.position)
    eye.rotation_euler = (z_up(camera.target) - z_up(camera.position)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.collection.objects.link(eye)
    bpy.context.scene.camera = eye


def set_up(orders, samples, step_rate, size):
    """Cycles without its biases: no clamping, no roulette on weak lights, a box filter, fine steps in grids."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    bounces = 128 if orders == ALL_ORDERS else orders - 1
    cycles.max_bounces = cycles.volume_bounces = cycles.diffuse_bounces = bounces
    cycles.min_light_bounces = cycles.min_transparent_bounces = 0
    cycles.transparent_max_bounces = 1024  # the faces around a grid count
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    cycles.pixel_filter_type = "BOX"
    cycles.volume_step_rate = step_rate
    cycles.volume_max_steps = 65536
    scene.world = None
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = *size, 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.view_settings.view_transform = "Raw"


def render(job):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    world = job.scene
    for box in world.boxes:
        add_box(box.low, box.high, material("box", ("ShaderNodeBsdfDiffuse", {"Color": (*box.color, 1)}),
                                            socket="Surface"))
    add_fog(world.fog, job.vdb, job.voxel_size)
    add_light(world.light)
    add_camera(world.camera)
    set_up(job.orders, job.samples, job.step_rate, world.size)
    for seed in job.seeds:
        bpy.context.scene.cycles.seed = seed
        bpy.context.scene.render.filepath = f"{job.output}{seed}.exr"
        start = time.time()
        bpy.ops.render.render(write_still=True)
        pathlib.Path(f"{job.output}{seed}.seconds").write_text(f"{time.time() - start:.3f}\n")
        np.save(f"{job.output}{seed}.npy", pixels(bpy.context.scene.render.filepath))


def main():
    text = pathlib.Path(sys.argv[sys.argv.index("--") + 1]).read_text()
    job = json.loads(text, object_hook=lambda fields: types.SimpleNamespace(**fields))
    if hasattr(job, "exr"):
        for path in job.exr:
            np.save(pathlib.Path(path).with_suffix(".npy"), pixels(path))
    else:
        render(job)


main()
