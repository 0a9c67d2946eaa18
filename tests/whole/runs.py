"""Runs a case, and compares what it made with CGAL and with the driver's own reckoning."""
import os
import re
import shlex
import shutil
import subprocess

import comparison
import cut_meshes
import mesh_files
from expected import Expected
from oracle import Failed

TOO_LITTLE = re.compile(rb"memory (is|are) too little.*--memory (\d+)([MG])")
MPIRUN = ["mpirun", "--oversubscribe", "--bind-to", "none"]
SECONDS = 120

# Errors that are right for points without a simplex.
NO_SIMPLEX = re.compile(r"the filters leave no points|nothing is left$|"
                        r"the input has (no|only \d+ distinct) points?|"
                        r"lie (on one line|in one plane|in one space of fewer dimensions)")


class Outcome:
    def __init__(self, *what):
        self.what = what


def fresh_folder(folder):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(f"{folder}/out")
    os.makedirs(f"{folder}/scratch")
    os.chdir(folder)


def output_of(case):
    tile = "_{x}_{y}" if case.option("--tiles") else ""
    return f"out/mesh{tile}.{mesh_files.end_of(case.form)}"


def command_of(case, binary):
    """The arguments of the run, in its folder."""
    names = ["-"] if case.pipe_in else [one.name(i) for i, one in enumerate(case.inputs)]
    arguments = [*(MPIRUN + ["-n", str(case.ranks)] if case.ranks else []), binary, "triangulate",
                 *names, "-o", "-" if case.pipe_out else output_of(case),
                 "--output-format", case.form, "--dim", str(case.dim), "--scratch-folder", "scratch",
                 "--progress", "none"]
    if not case.pipe_out:
        arguments += ["--stats", "out/stats.json"]
    if case.pipe_in and case.inputs[0].form in ("text", "csv", "text-gz"):
        arguments += ["--input-format", "text"]
    for one in case.filters:
        arguments += one.arguments
    for option in case.options:
        arguments += option
    return arguments


def shown(case, binary):
    """The command as a line of the shell."""
    line = shlex.join(command_of(case, binary))
    if case.pipe_in:
        line = f"cat {case.inputs[0].name(0)} | {line}"
    return line + (f" > {output_of(case)}" if case.pipe_out else "")


def call(arguments, case):
    stdin = subprocess.DEVNULL
    feeder = None
    if case.pipe_in:
        feeder = subprocess.Popen(["cat", case.inputs[0].name(0)], stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL)
        stdin = feeder.stdout
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    if not case.ranks:
        environment["TMPDIR"] = os.path.abspath("scratch")
    try:
        seconds = SECONDS + case.points() / 500  # a busy machine, and points on one circle
        done = subprocess.run(arguments, stdin=stdin, capture_output=True, timeout=seconds,
                              env=environment)
    except subprocess.TimeoutExpired:
        raise Failed("no end", f"after {seconds:.0f} seconds") from None
    finally:
        if feeder:
            feeder.stdout.close()
            feeder.kill()
            feeder.wait()
    return done


def check_clean(case, done):
    left = os.listdir("scratch")
    if left:
        raise Failed("temporary files are left", ", ".join(left))
    unfinished = [name for name in os.listdir("out") if name.endswith((".part", ".resume"))]
    if done.returncode != 0 and case.option("--resume"):  # it keeps what it can go on from
        shutil.rmtree("state", ignore_errors=True)
        for name in unfinished:
            os.remove(f"out/{name}")
    elif unfinished or os.path.exists("state"):
        raise Failed("unfinished files are left", ", ".join(unfinished + os.listdir(".")))


def give_memory(case, done):
    """Whether the run had too little memory; then the case gets what the error names, in space at
    least one and a half times as much."""
    named = TOO_LITTLE.search(done.stderr) if done.returncode == 1 else None
    if named is None or not case.option("--memory"):
        return False
    before = int(case.option("--memory")[1][:-1])
    after = int(named.group(2)) * (1024 if named.group(3) == b"G" else 1)
    if after <= before or case.points() < 20_000:
        raise Failed("too little memory for few points", done.stderr.decode()[-300:])
    if case.dim > 2:
        after = max(after, before * 3 // 2)
    case.options = [["--memory", f"{after}M"] if option[0] == "--memory" else option
                    for option in case.options]
    return True


def check_error(case, expected, done):
    """The outcome of a run that ended with an error, if that is a right one."""
    message = done.stderr.decode(errors="replace").strip()
    code = done.returncode
    if code < 0 or (code > 2 and not case.ranks) or code == 2:
        raise Failed(f"exit code {code}", message[-600:])
    if "spillway: error: " not in message:
        raise Failed("an error without a message", f"exit code {code}: {message[-600:]}")
    meshes = [name for name in os.listdir("out")]
    if meshes:
        raise Failed("a failed run has left an output", ", ".join(meshes))
    if NO_SIMPLEX.search(message):
        if len(expected.simplices):
            raise Failed("refused points that have a triangulation", message[-600:])
        return Outcome("no simplex")
    raise Failed("an error that is not expected", message[-600:])


def run_case(case, binary, cgal, folder):
    """Raises Failed if the run does not do what it should."""
    fresh_folder(folder)
    case = case.copy()
    case.inputs = [one.take(slice(None)) for one in case.inputs]
    for number, one in enumerate(case.inputs):
        one.write(binary, number)
    for name, text in [item for one in case.filters for item in one.files.items()]:
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)
    expected = Expected(case, cgal)
    if expected.unclear:
        return Outcome("unclear")
    told = []
    for _ in range(8):
        done = call(command_of(case, binary), case)
        check_clean(case, done)
        if not give_memory(case, done):
            break
        if told and case.dim == 2:
            raise Failed("the memory that an error names is not enough", done.stderr.decode()[-300:])
        told = ["more memory"]
    if done.returncode != 0:
        return check_error(case, expected, done)
    path = output_of(case)
    if case.pipe_out:
        with open(path, "wb") as file:
            file.write(done.stdout)
    if not len(expected.simplices):
        raise Failed("a mesh of points without simplices")
    is_cut = case.option("--tiles") or case.option("--parts")
    mesh = (cut_meshes.read(binary, case) if is_cut else
            mesh_files.read_mesh(binary, path, case.form, case.dim))
    comparison.check_mesh(case, expected, mesh)
    told += [] if case.pipe_out else comparison.check_stats(case, expected)
    if is_cut:
        told.append("in several files")
    else:
        comparison.check_proof(case, binary, path)
    return Outcome("the same", *told)
