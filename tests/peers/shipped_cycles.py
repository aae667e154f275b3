"""A scene file of ours in Cycles, as far as its time depends on it: python shipped_cycles.py JOB.json
A job is {scene, frame, size, samples, threads, seeds, sampling, output}. Geometry is the .glb with Lambert materials, cut out
leaves and glowing ones; fog is the .vdb, boxes and height fog; fire's grid of temperature becomes one of emission. What
differs: spots have neither IES profile nor gobo and Blender's falloff, and stand still, as Cycles blurs no lamp."""
import json
import math
import pathlib
import sys
import types

import cycles_peer as peer
from cycles_peer import add, add_box, bpy, empty_tree, np, z_up

import blackbody


def at(value, seconds):
    """Of a number or keys: eased between the two around a moment, looped."""
    if not isinstance(value, dict):
        return value
    keys = value["keys"]
    first, last = keys[0][0], keys[-1][0]
    t = first + (seconds - first) % (last - first) if value.get("loop") else min(max(seconds, first), last)
    for (a, start), (b, end) in zip(keys, keys[1:]):
        if a <= t <= b:
            x = (t - a) / (b - a)
            x = x * x * (3 - 2 * x) if value.get("interpolation") == "smooth" else x
            return (np.array(start) + x * np.subtract(end, start)).tolist()
    return keys[-1][1]


def lambert(material, described):
    """Replaces an imported material by what the scene's renderer makes of it."""
    tree = material.node_tree
    texture = next((node.image for node in tree.nodes if node.bl_idname == "ShaderNodeTexImage"), None)
    tree = empty_tree(material)
    shader, output = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Color"].default_value = described["pbrMetallicRoughness"]["baseColorFactor"]
    result = shader.outputs[0]
    if any(described.get("emissiveFactor", ())):
        glow, both = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeAddShader")
        glow.inputs["Color"].default_value = (*described["emissiveFactor"], 1)
        glow.inputs["Strength"].default_value = described["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"]
        tree.links.new(result, both.inputs[0])
        tree.links.new(glow.outputs[0], both.inputs[1])
        result = both.outputs[0]
    if texture:
        image, tint, cut, mix, clear = [tree.nodes.new("ShaderNode" + kind) for kind in
                                        ("TexImage", "VectorMath", "Math", "MixShader", "BsdfTransparent")]
        image.image, tint.operation, cut.operation = texture, "MULTIPLY", "GREATER_THAN"
        tint.inputs[1].default_value = described["pbrMetallicRoughness"]["baseColorFactor"][:3]
        cut.inputs[1].default_value = described.get("alphaCutoff", 0.5)
        for source, sink in ((image.outputs["Color"], tint.inputs[0]), (tint.outputs[0], shader.inputs["Color"]),
                             (image.outputs["Alpha"], cut.inputs[0]), (cut.outputs[0], mix.inputs[0]),
                             (clear.outputs[0], mix.inputs[1]), (result, mix.inputs[2])):
            tree.links.new(source, sink)
        result = mix.outputs[0]
    tree.links.new(result, output.inputs["Surface"])


def add_geometry(path):
    blob = path.read_bytes()
    described = json.loads(blob[20:20 + int.from_bytes(blob[12:16], "little")])
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.import_scene.gltf(filepath=str(path))
    for material in described["materials"]:
        if material["name"] in bpy.data.materials:
            lambert(bpy.data.materials[material["name"]], material)


def add_light(light, seconds):
    color, sun = light.get("color", [1, 1, 1]), light["type"] == "sun"
    if "temperature" in light:
        color = (np.array(color) * blackbody.color(np.array([light["temperature"]]))[0]).tolist()
    data = bpy.data.lights.new(light["name"], "SUN" if sun else "SPOT")
    lamp = add(light["name"], data)
    data.color = color
    if sun:
        data.energy, data.angle = light["intensity"], 2 * math.radians(light["angle"])
        aim = z_up(light["direction"])
    else:
        data.energy, data.shadow_soft_size = light["intensity"] * 4 * math.pi, light["radius"]
        data.spot_size, data.spot_blend = 2 * math.radians(light["outer_cone"]), 1 - light["inner_cone"] / light["outer_cone"]
        lamp.location = z_up(light["position"])
        aim = z_up(at(light["target"], seconds)) - lamp.location
    lamp.rotation_euler = aim.to_track_quat("-Z", "Y").to_euler()


def add_sky(sky, lights_scene):
    """The gradient as a map; where it lights nothing, only the camera sees it."""
    y = np.cos(math.pi * (np.arange(512) + 0.5) / 512)[:, None, None]
    share = y * y * (3 - 2 * abs(y))
    rows = np.where(y >= 0, sky["zenith"], sky.get("ground", sky["horizon"])) * share + np.array(sky["horizon"]) * (1 - share)
    image = bpy.data.images.new("sky", 8, 512, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    flat = np.ones((512, 8, 4), np.float32)
    flat[..., :3] = rows[::-1]
    image.pixels.foreach_set(flat.ravel())
    peer.world_of(image, 1)
    if not lights_scene:
        seen = bpy.context.scene.world.cycles_visibility
        seen.diffuse = seen.glossy = seen.transmission = seen.scatter = False


def scaled(tree, source, vector, sink):
    node = tree.nodes.new("ShaderNodeVectorMath")
    node.operation = "SCALE"
    node.inputs[0].default_value = vector
    tree.links.new(source, node.inputs["Scale"])
    tree.links.new(node.outputs[0], sink)


def height_density(tree, medium):
    """exp(-(height over base) / falloff), 1 below it."""
    place, split = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(place.outputs["Position"], split.inputs[0])
    value = split.outputs["Z"]
    for operation, number in (("SUBTRACT", medium["base"]), ("MAXIMUM", 0), ("DIVIDE", -medium["falloff"]), ("EXPONENT", 0)):
        node = tree.nodes.new("ShaderNodeMath")
        node.operation = operation
        node.inputs[1].default_value = number
        tree.links.new(value, node.inputs[0])
        value = node.outputs[0]
    return value


def fog_material(medium, sampling):
    result = bpy.data.materials.new(medium["name"])
    result.cycles.volume_sampling = sampling
    tree = empty_tree(result)
    node, output = tree.nodes.new("ShaderNodeVolumeCoefficients"), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(node.outputs[0], output.inputs["Volume"])
    node.inputs["Anisotropy"].default_value = medium["g"]
    scattering = medium["extinction"] * medium["albedo"]
    coefficients = {"Scatter Coefficients": [scattering] * 3,
                    "Absorption Coefficients": [medium["extinction"] - scattering] * 3}
    density = None
    if medium["type"] == "vdb":
        attribute = tree.nodes.new("ShaderNodeAttribute")
        attribute.attribute_name = "density"
        density = attribute.outputs["Fac"]
    elif medium["type"] == "height":
        density = height_density(tree, medium)
    for name, value in coefficients.items():
        if density:
            scaled(tree, density, value, node.inputs[name])
        else:
            node.inputs[name].default_value = value
    if "blackbody" in medium:
        glow = tree.nodes.new("ShaderNodeAttribute")
        glow.attribute_name = "emission"
        tree.links.new(glow.outputs["Color"], node.inputs["Emission Coefficients"])
    return result


def with_emission(path, medium):
    """A copy of a .vdb with what its temperature emits, nits per meter."""
    sys.path += map(str, pathlib.Path(bpy.__file__).parents[3].glob("python/lib/python*/site-packages"))
    import openvdb
    grids = {grid.name: grid for grid in openvdb.readAll(str(path))[0]}
    temperature = grids["temperature"]
    low, high = temperature.evalActiveVoxelBoundingBox()
    kelvin = np.zeros([b - a + 1 for a, b in zip(low, high)], np.float32)
    temperature.copyToArray(kelvin, ijk=low)
    nits = np.where(kelvin[..., None] > 300, blackbody.radiance(np.maximum(kelvin, 300)), 0)
    nits *= medium["blackbody"]["emission_scale"]
    emission = openvdb.Vec3SGrid()
    emission.copyFromArray(nits.astype(np.float32), ijk=low)
    emission.name, emission.transform = "emission", temperature.transform
    result = path.with_name(path.stem + "_emission.vdb")
    openvdb.write(str(result), grids=[grids["density"], emission])
    return result


def add_medium(medium, folder, sampling):
    look = fog_material(medium, sampling)
    if medium["type"] != "vdb":
        return add_box(medium["bounds"]["low"], medium["bounds"]["high"], look)
    path = folder / medium["file"]
    data = bpy.data.volumes.new(medium["name"])
    data.filepath = str(with_emission(path, medium) if "blackbody" in medium else path)
    data.render.clipping, data.render.precision = 0, "FULL"
    data.materials.append(look)
    add(medium["name"], data).rotation_euler = (math.pi / 2, 0, 0)


def build(job):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    path = pathlib.Path(job.scene)
    document, folder = json.loads(path.read_text()), path.parent
    seconds = job.frame / document["frame_rate"]
    bpy.context.scene.world = None
    bpy.context.scene.render.fps = document["frame_rate"]
    if "gltf" in document:
        add_geometry(folder / document["gltf"])
    environment = False
    for light in document.get("lights", []):
        environment |= light["type"] == "environment"
        if light["type"] != "environment":
            add_light(light, seconds)
    if "background" in document:
        add_sky(document["background"]["sky"], environment)
    for medium in document["media"]:
        add_medium(medium, folder, job.sampling)
    peer.add_camera(types.SimpleNamespace(**document["camera"]))


def main():
    job = types.SimpleNamespace(**json.loads(pathlib.Path(sys.argv[1]).read_text()))
    build(job)
    peer.set_up(1, job.samples, job.size, job.threads)
    bpy.context.scene.frame_set(job.frame)
    peer.render(job.seeds, job.output)


if __name__ == "__main__":
    main()
