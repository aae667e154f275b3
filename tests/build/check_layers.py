"""Fails when a file includes a layer above its own, a technique the folder of another one, or a file a library outside the
layer that owns it, or when two headers give one name to different types: those link without a word and crash."""
import pathlib
import re
import sys

LAYERS = ["base", "volume", "scene", "trace", "integrate", "modes", "render", "measure", "viewer"]
OWNERS = {  # header prefix -> where it may be included
    "tbb/": ["src/base"], "nlohmann/": ["src/base"], "openvdb/": ["src/volume/vdb"],
    "nanovdb/": ["src/volume/vdb"], "blosc.h": ["src/volume/vdb"], "embree": ["src/trace/occlusion/embree.h"], "trace/occlusion/embree.h": ["src/trace/occlusion"],
    "trace/occlusion/scene.h": ["src/trace/occlusion"], "tiny_gltf": ["src/scene"],
    "stb_image.h": ["src/scene"], "stb_image_write": ["src/render"], "OpenEXR/": ["src/base/exr", "src/render/image/exr"],
    "Imf": ["src/base/exr", "src/render/image/exr"], "CLI/": ["apps"], "GLFW/": ["apps"], "GL/": ["apps"], "imgui": ["apps"],
}

TECHNIQUE = re.compile(r"src/modes/(\w+)/")

root = pathlib.Path(sys.argv[1])
problems = []
for path in sorted([*root.glob("src/**/*.h"), *root.glob("src/**/*.cpp"), *root.glob("apps/**/*.cpp"), *root.glob("apps/**/*.h")]):
    relative = path.relative_to(root).as_posix()
    own = relative.split("/")[1] if relative.startswith("src/") else None
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
        if not match:
            continue
        included = match.group(1)
        layer = included.split("/")[0]
        if own in LAYERS and layer in LAYERS and "/" in included and LAYERS.index(layer) > LAYERS.index(own):
            problems.append(f"{relative}:{number}: {own} includes {included}, a layer above it")
        technique, other = TECHNIQUE.match(relative), TECHNIQUE.match(f"src/{included}")
        if technique and other and technique[1] != other[1]:
            problems.append(f"{relative}:{number}: {technique[1]} includes {included}, a part of another technique")
        for prefix, allowed in OWNERS.items():
            if included.startswith(prefix) and not any(relative.startswith(place) for place in allowed):
                problems.append(f"{relative}:{number}: {included} belongs in {', '.join(allowed)} only")
named = {}
shared_tests = [path for path in root.glob("tests/**/*.h") if "namespace tyndall::test" not in path.read_text()]
for path in sorted([*root.glob("src/**/*.h"), *root.glob("apps/**/*.h"), *shared_tests]):
    relative = path.relative_to(root).as_posix()
    kernel = path.name.endswith("_simd.h")  # has a namespace for each instruction set
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = re.match(r"(?:template<[^>]*> )?(?:struct|class|enum class) (\w+)\b(?!::)[^;()]*\{", line)
        if match and not kernel and named.setdefault(match.group(1), relative) != relative:
            problems.append(f"{relative}:{number}: {match.group(1)} is also in {named[match.group(1)]}")
print("\n".join(problems) or "layers: ok")
sys.exit(1 if problems else 0)
