"""Deliberate faults in the code behind targets, bounds and budgets, and in that of lights, media and motion, one after the
other: a test or the proving ground must find each of them.

    mutations.py -o FOLDER [--only NAME,...] [--seeds 4,18,27,42,55,69] [--truths DIR]
    mutations.py --check

Works on a copy of the committed files in FOLDER, which it builds. Prints who found each fault; ends with 1 where one was
found by nobody, or where the copy fails without a fault. --check only looks whether the code still has the lines that the
faults replace."""
import argparse
import dataclasses
import io
import pathlib
import subprocess
import sys
import tarfile
import time

SOURCE = pathlib.Path(__file__).parents[2]
TESTS = r"^render\."  # whole programs miss times on a busy machine, whatever the fault
OF_PARTS = r"^(render\.|cli\.farm\.parts$|proving\.parts$)"
TARGETS = ["tyndall", "test_render"]
OF_LIGHT = ["test_scene", "test_volume", "test_modes", "test_render"]


@dataclasses.dataclass
class Fault:
    name: str
    file: str
    right: str
    wrong: str
    tests: str = TESTS
    targets: list = dataclasses.field(default_factory=lambda: TARGETS)


def of_light(name, file, right, wrong, tests):
    return Fault(name, file, right, wrong, rf"^({tests})$", OF_LIGHT)


ADAPTIVE = "src/render/adaptive/"
FAULTS = [
    Fault("noise-without-tail", "src/render/frame/layers.cpp", "bound(std::max(freedom, 3.0)), bound(certain)};",
          "std::sqrt(variance) / mean, std::sqrt(variance) / mean + 0 * bound(freedom)};"),
    Fault("bound-halved", "src/render/frame/frame.cpp", "std::hypot(noise->bound, ", "0.5 * std::hypot(noise->bound, "),
    Fault("integrator-without-tail", ADAPTIVE + "pilot.cpp",
          "const double bound = std::max(value, 0.0) + confidence * (half + std::sqrt(variance + half * half));",
          "const double bound = std::max(value, 0.0) + 0 * half;"),
    Fault("pilot-skips-edges", ADAPTIVE + "tile_chances.cpp", "const auto square = [](vec3 value) { return channel_mean(value * value); };",
          "const auto square = [](vec3 value) { return 1 / (1e-6 + channel_mean(value * value)); };"),
    Fault("tiles-without-weights", ADAPTIVE + "tile_chances.cpp", "drawn.push_back({corner(i), chance, 1 / chance});",
          "drawn.push_back({corner(i), chance, 1});"),
    Fault("check-with-the-pilots-samples", ADAPTIVE + "check.cpp", "chances(), salt,", "chances(), 0 * salt,"),
    Fault("rounds-of-the-same-samples", ADAPTIVE + "target_rounds.h",
          "if (numbers > 0) result.seed = hash(view.seed, static_cast<uint32_t>(numbers));", ""),
    Fault("integrator-left-out", "src/render/frame/frame.cpp", "integrator ? integrator->error : none", "none"),
    Fault("orders-left-out", "src/render/frame/frame.cpp", "orders ? orders->pixels : none", "none"),
    Fault("orders-of-one-product", ADAPTIVE + "errors/orders.cpp", "channel_mean(sums[i] * sums[i] - squares[i])", "channel_mean(sums[i] * sums[i])"),
    Fault("planning-not-counted", ADAPTIVE + "to_target.cpp", "stats.goal_seconds = goal.clock() - rounds.start;\n    if (options.progress)",
          "stats.goal_seconds = stats.render_seconds;\n    if (options.progress)"),
    Fault("loading-not-counted", "src/render/sequence/render_stage.cpp",
          "request.started + request.time_budget * (pipeline.rendered + ahead)", "steady_seconds() + request.time_budget * ahead"),
    Fault("misses-by-the-likely-error", "src/render/sequence/sequence.cpp",
          "frame.stats.error()->bound > request.target_error", "frame.stats.error()->error > 2 * request.target_error"),
    Fault("leaf-counted-twice", "src/render/frame/merge.cpp",
          "sums = node_sums(nodes, {node.section, node.level - 1, 2 * node.index}, first, count);",
          "sums = node_sums(nodes, {node.section, node.level - 1, 2 * node.index + 1}, first, count);", OF_PARTS),
    Fault("groups-with-one-scramble", "src/trace/view.cpp", "return {batch ? hash(key, batch) : key, index};",
          "return {key, index};", OF_PARTS),
    Fault("planned-integrator-left-out", ADAPTIVE + "planned.cpp", "if (!planned.is_checked()) return;", "return stats.integrator.reset();"),
    Fault("planned-orders-left-out", ADAPTIVE + "planned.cpp", "if (planned.orders) stats.orders = planned.orders;", ""),
    Fault("variances-known-for-certain", "src/render/frame/layers.cpp", "squared_error += square;",
          "squared_error += 1e-6 * square;"),
    of_light("fire-counted-twice", "src/integrate/lights/fire_light.cpp", " + by_fog * by_phase * place.line_pdf);", ");",
             r"modes\.fire_light"),
    of_light("fire-without-its-distance", "src/trace/lights/emission_surface.cpp", "place.pdf * away * away", "place.pdf * away",
             r"modes\.fire_light"),
    of_light("glowing-faces-without-cosine", "src/integrate/lights/mesh_light.cpp",
             "std::abs(glm::dot(target.normal, direction)) *", "", r"modes\.mesh_light"),
    of_light("faces-by-angle-alone", "src/integrate/lights/face_light.cpp",
             "(distances.angles.pdf(t) + distances.fog.pdf(extinction, transmittance))", "distances.angles.pdf(t)",
             r"modes\.face_light"),
    of_light("rectangles-off-their-middle", "src/scene/lights/spherical_rectangle.cpp", "middle - half, high = middle + half;",
             "middle - half, high = middle + 0.9 * half;", r"modes\.face_light|scene\.area_shape"),
    of_light("sky-without-its-phase", "src/integrate/lights/environment_light.cpp", "(weight / (by_light + by_phase))",
             "(weight / (by_light + by_light))", r"modes\.environment"),
    of_light("sky-of-another-size", "src/trace/lights/environment.cpp", "2 * std::numbers::pi / table.texels.x *",
             "2.1 * std::numbers::pi / table.texels.x *", r"modes\.environment"),
    of_light("channels-swapped", "src/render/frame/channels.cpp", "to.tint[c] = from.transmittance", "to.tint[2 - c] = from.transmittance",
             r"render\.channels"),
    of_light("channels-followed-by-one", "src/modes/path/vertex.h", "line.pdfs / mean_component(line.pdfs)", "1.0f + 0.0f * line.pdfs",
             r"render\.channels"),
    of_light("shutter-late", "src/scene/shutter.cpp", "(k + 0.5) / count", "(k + 1.0) / count", r"scene\.shutter|render\.shutter"),
    of_light("lens-in-focus-everywhere", "src/scene/lens.cpp", "- off / camera.lens.focus;", "- 0.0f * off;",
             r"scene\.lens|modes\.lens|render\.lens_pictures"),
    of_light("draine-by-henyey-greenstein", "src/volume/phase/lobe.cpp", "4 * std::numbers::pi * (1 + alpha * (1 + 2 * g * g) / 3);",
             "4 * std::numbers::pi;", r"volume\.(phase|lobe)"),
    of_light("gobo-a-texel-off", "src/scene/lights/gobo.cpp", "at * texels + 0.5,", "at * texels + 1.5,", r"scene\.gobo"),
    of_light("nanovdb-turned", "src/volume/vdb/nano/tree.cpp", "return {number >> 2 * bits, number >> bits & mask, number & mask};",
             "return {number & mask, number >> bits & mask, number >> 2 * bits};", r"volume\.nano"),
    of_light("fire-counted-twice-in-smoke", "src/modes/path/emission.cpp", "{place.line_pdf / pdf,", "{1,",
             r"modes\.(grid_emission|fire_light)"),
    of_light("lamps-brighter-than-their-fire", "src/integrate/lights/fire_lamps.cpp", "part.candela += place.candela,",
             "part.candela += 1.1 * place.candela,", r"modes\.fire_light"),
]


def copy_committed(folder):
    """Only what is not there alike, so that a folder may be built again after a commit."""
    files = subprocess.run(["git", "archive", "HEAD"], cwd=SOURCE, capture_output=True, check=True).stdout
    with tarfile.open(fileobj=io.BytesIO(files)) as archive:
        for member in archive:
            place = folder / member.name
            if member.isfile() and place.is_file() and place.read_bytes() == archive.extractfile(member).read():
                continue
            member.mtime = time.time()
            archive.extract(member, folder)


def run(command, folder, **more):
    return subprocess.run(list(map(str, command)), cwd=folder, capture_output=True, text=True, **more)


def build(folder, targets):
    done = run(["cmake", "--build", "build/release", "--target", *targets], folder)
    return done.returncode == 0, done.stdout[-2000:]


def who_finds(folder, options, tests, targets):
    """The first tests that fail, or else the proving ground's word; nobody where all pass."""
    ok, said = build(folder, targets)
    if not ok:
        sys.exit(f"does not build:\n{said}")
    tested = run(["ctest", "--test-dir", "build/release", "-R", tests, "-LE", "nightly", "-j2",
                  "--stop-on-failure"], folder)
    failed = sorted({line.split(" - ")[1].split()[0] for line in tested.stdout.splitlines() if line.endswith("(Failed)")
                     or line.endswith("(Timeout)")})
    if failed:
        return ", ".join(failed)
    truths = ["--truths", options.truths.resolve()] if options.truths else []
    proven = run([sys.executable, "tests/proving/run.py", "--seeds", options.seeds, "--program", "build/release/tyndall",
                  "-o", folder / "proving", *truths], folder)
    return "" if proven.returncode == 0 else "proving ground"


def misfit(fault, folder):
    """Why a fault cannot be planted; empty if it can."""
    times = (folder / fault.file).read_text().count(fault.right)
    return "" if times == 1 else f"{fault.name}: {fault.file} holds '{fault.right}' {times} times"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    wanted = parser.add_mutually_exclusive_group(required=True)
    wanted.add_argument("-o", "--output", type=pathlib.Path)
    wanted.add_argument("--check", action="store_true")
    parser.add_argument("--only", type=lambda text: text.split(","), default=[])
    parser.add_argument("--seeds", default="4,18,27,42,55,69")
    parser.add_argument("--truths", type=pathlib.Path, help="a folder that keeps truths from run to run")
    options = parser.parse_args()
    if options.check:
        sys.exit("\n".join(misfit(fault, SOURCE) for fault in FAULTS if misfit(fault, SOURCE)) or 0)
    folder = options.output.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    copy_committed(folder)
    if not (folder / "build/release/build.ninja").exists():
        run(["cmake", "--preset", "release", "-D", "TYNDALL_VIEW=OFF", "-D", "TYNDALL_BENCHMARKS=OFF"], folder, check=True)

    missed = []
    if not options.only and (found := who_finds(folder, options, OF_PARTS, TARGETS)):
        sys.exit(f"without a fault: {found} fails")
    for fault in FAULTS:
        if options.only and fault.name not in options.only:
            continue
        place = folder / fault.file
        text = place.read_text()
        if misfit(fault, folder):
            sys.exit(misfit(fault, folder))
        place.write_text(text.replace(fault.right, fault.wrong))
        try:
            found = who_finds(folder, options, fault.tests, fault.targets)
        finally:
            place.write_text(text)
        print(f"{fault.name:36s} {found or 'FOUND BY NOBODY'}", flush=True)
        missed += [] if found else [fault.name]
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
