"""Runs the unit tests of a build with sanitizers: those that took less than two seconds in the last test run of a release
build, or with --slow all others.

    sanitized_tests.py SANITIZED RELEASE [--slow]

Many tests share a process, as starting one takes longer than most tests do. Prints the output of processes that fail."""
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

QUICK = 2.0  # seconds in release
BATCH = 4.0  # seconds in release that one process is given
PATIENCE = 60  # how much slower than in release a process may be before it is ended
LEAST_PATIENCE = 300  # seconds
SHOWN_LINES = 60
STABILITY = ("measure.stress", "measure.stress_mutation")  # minutes of whole pictures: with the slow ones


def seconds_in_release(build):
    """Seconds of each test, by part and name."""
    reports = list((build / "test_times").glob("*.json"))
    if not reports:
        sys.exit(f"sanitized_tests: {build}/test_times is missing: run the tests of {build} first")
    reports = [report for report in reports if report.stem not in STABILITY]
    return {(report.name.split(".")[0], f"{suite['name']}.{test['name']}"): float(test["time"].removesuffix("s"))
            for report in reports for suite in json.loads(report.read_text())["testsuites"]
            for test in suite["testsuite"]}


def tests_of(program):
    """Names of all tests of a Google Test program."""
    listed = subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
    names, suite = [], ""
    for line in listed.splitlines():
        name = line.split("#")[0].rstrip()
        if not line.startswith(" "):
            suite = name
        else:
            names.append(suite + name.strip())
    return names


def batches(program, seconds, slow):
    """Lists of tests, each about BATCH seconds in release; slow ones alone."""
    part, batch, sum_of_batch = program.name.removeprefix("test_"), [], 0
    for name in tests_of(program):
        cost = seconds.get((part, name))
        if (cost is None or cost >= QUICK) != slow:
            continue
        batch.append(name)
        sum_of_batch += QUICK if cost is None else cost
        if slow or sum_of_batch >= BATCH:
            yield program, batch, sum_of_batch
            batch, sum_of_batch = [], 0
    if batch:
        yield program, batch, sum_of_batch


def run(program, names, seconds):
    """What went wrong, or nothing."""
    environment = os.environ | {
        "ASAN_OPTIONS": "detect_leaks=1:strict_string_checks=1:allocator_may_return_null=1",
        "UBSAN_OPTIONS": "print_stacktrace=1",
        "GTEST_BRIEF": "1",
    }
    command = [program, "--gtest_filter=" + ":".join(names)]
    try:
        result = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                errors="replace", timeout=max(LEAST_PATIENCE, PATIENCE * seconds))
    except subprocess.TimeoutExpired:
        return f"{program.name}: not done after {max(LEAST_PATIENCE, PATIENCE * seconds):.0f} s: {' '.join(names)}"
    shown = "\n".join(result.stdout.splitlines()[-SHOWN_LINES:])
    return f"{program.name}: exit {result.returncode}: {' '.join(names)}\n{shown}" if result.returncode else ""


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--slow"]
    sanitized, release = map(pathlib.Path, arguments)
    seconds, programs = seconds_in_release(release), sorted((sanitized / "tests").glob("test_*"))
    waiting = [batch for program in programs if program.is_file() and os.access(program, os.X_OK)
            for batch in batches(program, seconds, "--slow" in sys.argv)]
    waiting.sort(key=lambda batch: -batch[2])
    failures = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for told in pool.map(lambda batch: run(*batch), waiting):
            failures += bool(told)
            if told:
                print(told, flush=True)
    print(f"{sum(len(names) for _, names, _ in waiting)} tests in {len(waiting)} processes, {failures} of them failed")
    sys.exit(1 if failures or not waiting else 0)


main()
