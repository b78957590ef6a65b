#!/usr/bin/env python3
"""What is installed, together with every library that it needs and that is not glibc's, for use without root and without packages:

    bundle.py archive BUILD_FOLDER FOLDER     writes FOLDER/driftwright-<version>-linux-x86_64.tar.gz: program, library, headers, scenarios
    bundle.py wheel BUILD_FOLDER FOLDER       writes FOLDER/driftwright-<version>-cp3xx-cp3xx-manylinux_2_yy_x86_64.whl: the Python package

It is what the CMake targets `archive` and `wheel` run (docs/how-to/install.md). Needs Debian (`dpkg-query` finds the licence of each library), `patchelf`
and binutils. Libraries of the archive are Debian's files unchanged: the program finds them by an RPATH of its own, which holds for what they need in turn. Those of the
wheel have other names, but for Gmsh, because a Python process may load other versions of the same libraries; libstdc++ and libgcc_s are the system's there, as PEP 600 has it.
"""
import argparse, base64, csv, gzip, hashlib, io, os, re, shutil, subprocess, sys, tarfile, tempfile, time, zipfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
# Of glibc: they must be those of the kernel's and the loader's own system.
GLIBC = {"ld-linux-x86-64.so.2", "libc.so.6", "libm.so.6", "libmvec.so.1", "libpthread.so.0", "libdl.so.2", "librt.so.1", "libresolv.so.2", "libutil.so.1",
         "libanl.so.1", "libnsl.so.1", "libBrokenLocale.so.1", "libthread_db.so.1"}
COMPILER = {"libstdc++.so.6", "libgcc_s.so.1"}
# Packages of headers that are compiled in.
HEADERS = ["libeigen3-dev", "libcli11-dev", "nlohmann-json3-dev", "libspectra-dev", "libhowardhinnant-date-dev", "libboost-dev"]
UNIT_TABLE = Path("share/driftwright/units")  # base/quantity.cpp looks for it there


def run(*command, **options):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"bundle.py: {' '.join(map(str, command))} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def needs(tool, package):
    if not shutil.which(tool):
        sys.exit(f"bundle.py: '{tool}' is missing; Debian: apt-get install {package}")


class Build:
    """What CMake has configured and built."""

    def __init__(self, folder):
        self.folder = Path(folder).resolve()
        cache = self.folder / "CMakeCache.txt"
        if not cache.is_file():
            sys.exit(f"bundle.py: {self.folder} is no build folder: it has no CMakeCache.txt")
        self.cache = dict(re.findall(r"^([^#/:\n]+):[A-Z]+=(.*)$", cache.read_text(), re.M))
        self.version = self.cache["CMAKE_PROJECT_VERSION"]
        self.on_demand = {}  # name and path of a library that the program loads when it first needs it
        if "DRIFTWRIGHT_ON_DEMAND_NAME" in self.cache:
            self.on_demand[self.cache["DRIFTWRIGHT_ON_DEMAND_NAME"]] = Path(self.cache["DRIFTWRIGHT_ON_DEMAND_LIBRARY"]).resolve()
        self.lib = self.cache.get("CMAKE_INSTALL_LIBDIR", "lib")
        flags = self.cache.get("CMAKE_CXX_FLAGS", "")
        if "-march=" in flags:
            self.processor = re.search(r"-march=(\S+)", flags)[1]
        else:
            automatic = self.cache.get("DRIFTWRIGHT_PROCESSOR") == "automatic" and self.cache.get("DRIFTWRIGHT_HAS_AVX2") == "1"
            self.processor = "x86-64-v3" if automatic else "x86-64"

    def install(self, prefix, *components):
        for component in components:
            run("cmake", "--install", self.folder, "--prefix", prefix, "--strip", "--component", component)


def needed_libraries(files):
    """Path by name, of everything that these files need in turn and glibc does not have."""
    found = {}
    environment = {k: v for k, v in os.environ.items() if not k.startswith("LD_")}
    for file in files:
        for line in run("ldd", file, env=environment).splitlines():
            word = line.split()
            if "=>" not in word or word[0] in GLIBC:
                continue
            if "not found" in line:
                sys.exit(f"bundle.py: {file} needs {word[0]}, which is not found here")
            if "glibc-hwcaps" in word[2]:
                sys.exit(f"bundle.py: {word[2]} is for processors of a kind; move it away, so that the file for all is taken")
            found[word[0]] = Path(word[2]).resolve()
    return found


def dynamic_section(file):
    """(names it needs, its search paths, versions of glibc's and the compiler's symbols)."""
    text = run("readelf", "--dynamic", "--version-info", "--wide", file)
    return (re.findall(r"\(NEEDED\).*\[(.*)\]", text), re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.*)\]", text),
            set(re.findall(r"Name: (GLIBC_[0-9.]+|GLIBC_ABI_DT_RELR|GLIBCXX_[0-9.]+)", text)))


def oldest_glibc(folder, system):
    """The glibc that all files below the folder run with, once each name that they need is known to be among them or in `system`."""
    files = [f for f in folder.rglob("*") if f.is_file() and not f.is_symlink() and f.open("rb").read(4) == b"\x7fELF"]
    names, newest = {f.name for f in folder.rglob("*")}, (2, 0)
    for file in files:
        needed, _, versions = dynamic_section(file)
        missing = [n for n in needed if n not in names and n not in system]
        if missing:
            sys.exit(f"bundle.py: {file.name} needs {', '.join(missing)}, which is not in the bundle")
        for version in versions:
            number = (2, 36) if version == "GLIBC_ABI_DT_RELR" else tuple(map(int, version[6:].split("."))) if version.startswith("GLIBC_") else (2, 0)
            newest = max(newest, number[:2])
    return newest


def packages_of(files):
    """The Debian package of each file."""
    spelt = {}
    for file in files:  # with and without the /usr that has been merged
        spelt.update({str(file): file, str(file).removeprefix("/usr"): file})
    listed = subprocess.run(["dpkg-query", "-S", *spelt], capture_output=True, text=True, check=False).stdout
    owner = {}
    for line in listed.splitlines():
        package, _, path = line.partition(": ")
        if path in spelt:
            owner[spelt[path]] = package.split(",")[0].split(":")[0]
    without = [str(f) for f in files if f not in owner]
    if without:
        sys.exit(f"bundle.py: no Debian package has {', '.join(without)}; its licence is not known")
    return owner


def write_licences(folder, libraries, headers):
    """The licence of each library and of headers that are compiled in, the texts that they refer to, and a list with versions and sources."""
    owner = packages_of(sorted(set(libraries.values())))
    packages = sorted(set(owner.values()) | set(headers))
    text = ""
    for package in packages:
        licence = Path("/usr/share/doc", package, "copyright").resolve()
        if not licence.is_file():
            sys.exit(f"bundle.py: {licence}, the licence of a library in the bundle, is missing")
        (folder / package).mkdir(parents=True)
        shutil.copyfile(licence, folder / package / "copyright")
        text += licence.read_text(errors="replace")
    (folder / "common-licenses").mkdir()
    for name in sorted(set(re.findall(r"common-licenses/([A-Za-z0-9.+-]*[A-Za-z0-9])", text))):
        if Path("/usr/share/common-licenses", name).exists():
            shutil.copyfile(Path("/usr/share/common-licenses", name), folder / "common-licenses" / name)
    about = run("dpkg-query", "-W", "-f", "${Package}\t${Version}\t${source:Package}\t${source:Version}\n", *packages)
    rows = [line.split("\t") for line in about.splitlines()]
    files = {package: sorted(n for n, f in libraries.items() if owner[f] == package) for package in packages}
    lines = [f"{package} {version}; source {source} {source_version}: {', '.join(files[package]) or 'headers'}\n" for package, version, source, source_version in sorted(rows)]
    (folder / "LIST.txt").write_text(
        "Debian packages whose files are in this bundle. Sources: apt-get source SOURCE=VERSION, or https://snapshot.debian.org/package/SOURCE/VERSION/\n\n" + "".join(lines))


def unit_table():
    """UDUNITS' own files, and their package."""
    files = sorted(Path("/usr/share/xml/udunits").glob("udunits2*.xml"))
    if not files:
        sys.exit("bundle.py: the unit table of UDUNITS-2 is missing; Debian: apt-get install libudunits2-data")
    return files


def copy_libraries(libraries, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, file in libraries.items():
        shutil.copyfile(file, folder / name)
        (folder / name).chmod(0o644)
        if dynamic_section(folder / name)[1]:  # it would hide the RPATH of whoever loads it
            run("patchelf", "--force-rpath", "--set-rpath", "$ORIGIN", folder / name)


READ_ME = """Driftwright {version}: a digital twin of a machine tool's thermal behaviour

    ./driftwright predict scenarios/first_machine.yaml --cyclogram shift
    ./driftwright run scenarios/fp3_spindle.yaml

The folder can lie anywhere and be moved; nothing has to be installed. It runs on Linux with glibc {glibc} or newer, on every
{processor} processor. To call it by its name, add the folder `bin` to PATH; `man -M share/man driftwright` shows the manual.

lib/ has every library that the program needs, and include/ the headers for programs of your own: find_package(driftwright)
with this folder in CMAKE_PREFIX_PATH. The system must provide, if you need them: names of time zones (tzdata) for `import`, and certificates
(ca-certificates) for `follow` from https addresses.

Licence: GNU General Public License, version 3 or later (share/doc/driftwright/LICENSE). The libraries in lib/ are those of Debian;
share/doc/driftwright/bundled/LIST.txt lists their packages, versions and sources, and has their licences beside it.
"""


def archive(build, out):
    name = f"driftwright-{build.version}-linux-{build.processor.replace('-', '_')}"
    with tempfile.TemporaryDirectory() as work:
        root = Path(work, name)
        build.install(root, "runtime", "library", "dev")
        program, shared = root / "bin/driftwright", next(f for f in sorted((root / build.lib).glob("libdriftwright.so.*")) if not f.is_symlink())
        libraries = {**build.on_demand, **needed_libraries([program, shared, *build.on_demand.values()])}
        run("patchelf", "--force-rpath", "--set-rpath", f"$ORIGIN/{os.path.relpath(root / build.lib, root / 'bin')}", program)
        run("patchelf", "--force-rpath", "--set-rpath", "$ORIGIN", shared)
        copy_libraries(libraries, root / build.lib)
        units = {f.name: f for f in unit_table()}
        (root / UNIT_TABLE).mkdir(parents=True)
        for file in units.values():
            shutil.copyfile(file, root / UNIT_TABLE / file.name)
        documents = root / "share/doc/driftwright"
        shutil.rmtree(root / "share/doc", ignore_errors=True)  # Debian's
        documents.mkdir(parents=True)
        for file in ("LICENSE", "CITATION.cff", "CHANGELOG.md"):
            shutil.copyfile(TOP / file, documents / file)
        write_licences(documents / "bundled", {**libraries, **units}, HEADERS)
        glibc = "2.{}".format(oldest_glibc(root, GLIBC)[1])
        (root / "README.txt").write_text(READ_ME.format(version=build.version, glibc=glibc, processor=build.processor))
        (root / "driftwright").symlink_to("bin/driftwright")
        (root / "scenarios").symlink_to("share/driftwright/scenarios")
        target = out / f"{name}.tar.gz"
        write_tar(root, target)
    print(f"{target}: {target.stat().st_size / 1e6:.1f} MB, {len(libraries)} libraries, glibc {glibc} or newer, processor {build.processor}")


def made_at():
    """The time of all files in a bundle, in seconds."""
    return int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))


def write_tar(root, target):
    """The folder as a compressed archive that depends on the files and the time alone."""
    def plain(entry):
        entry.uid = entry.gid = 0
        entry.uname = entry.gname = "root"
        entry.mtime = made_at()
        entry.mode = 0o755 if entry.isdir() or entry.mode & 0o100 else 0o644
        return entry

    partial = target.with_name(target.name + ".partial")
    with partial.open("wb") as file, gzip.GzipFile("", "wb", 6, file, made_at()) as packed, tarfile.open(fileobj=packed, mode="w") as tar:
        tar.add(root, root.name, recursive=False, filter=plain)
        for path in sorted(root.rglob("*")):
            tar.add(path, path.relative_to(root.parent), recursive=False, filter=plain)
    partial.rename(target)


def rename_libraries(folder, others, on_demand):
    """Gives each library in the folder a name that no other file has, and says so to what needs it; not to those that are loaded by their name."""
    new_name = {}
    for file in sorted(f for f in folder.iterdir() if f.name not in on_demand):
        stem, dot, rest = file.name.partition(".so")
        new_name[file.name] = f"{stem}-{hashlib.sha256(file.read_bytes()).hexdigest()[:8]}{dot}{rest}"
    for file in [*sorted(folder.iterdir()), *others]:
        origin = "$ORIGIN" if file.parent == folder else f"$ORIGIN/{os.path.relpath(folder, file.parent)}"
        changes = [[a for n in dynamic_section(file)[0] if n in new_name for a in ("--replace-needed", n, new_name[n])], ["--force-rpath", "--set-rpath", origin]]
        if file.name in new_name:
            changes.append(["--set-soname", new_name[file.name]])
        for change in filter(None, changes):  # one kind a call: patchelf 0.14 mixes up the words of several
            run("patchelf", *change, file)
    for old, new in new_name.items():
        (folder / old).rename(folder / new)


def numpy_wanted(build):
    """pybind11 before 2.12 knows the first NumPy alone."""
    file = Path(build.cache.get("pybind11_DIR", ""), "pybind11ConfigVersion.cmake")
    version = re.search(r'PACKAGE_VERSION "(\d+)\.(\d+)', file.read_text()) if file.is_file() else None
    return "numpy" if version and (int(version[1]), int(version[2])) >= (2, 12) else "numpy<2"


def wheel(build, out):
    found = sorted((build.folder / "python/driftwright").glob("core.cpython-*.so"))
    if len(found) != 1:
        sys.exit(f"bundle.py: {build.folder}/python/driftwright has no core.cpython-*.so; configure with -DDRIFTWRIGHT_PYTHON=ON and build")
    python = re.search(r"cpython-(\d)(\d+)", found[0].name)
    version = build.version if build.processor == "x86-64" else f"{build.version}+{re.sub(r'[^A-Za-z0-9]', '.', build.processor)}"
    with tempfile.TemporaryDirectory() as work:
        package, core = Path(work, "driftwright"), Path(work, "driftwright", found[0].name)
        package.mkdir()
        shutil.copyfile(found[0].parent / "__init__.py", package / "__init__.py")
        shutil.copyfile(found[0], core)
        run("strip", "--strip-unneeded", core)
        build.install(Path(work, "installed"), "library")
        shared = next(f for f in sorted(Path(work, "installed", build.lib).glob("libdriftwright.so.*")) if not f.is_symlink())
        name = next(n for n in dynamic_section(core)[0] if n.startswith("libdriftwright.so"))
        libraries = {**build.on_demand, **{n: f for n, f in needed_libraries([shared, *build.on_demand.values()]).items() if n not in COMPILER}}
        copy_libraries({**libraries, name: shared}, package / "lib")
        rename_libraries(package / "lib", [core], build.on_demand)
        units = {f.name: f for f in unit_table()}
        (package / UNIT_TABLE).mkdir(parents=True)
        for file in units.values():
            shutil.copyfile(file, package / UNIT_TABLE / file.name)
        glibc = oldest_glibc(package, GLIBC | COMPILER)
        tag = f"cp{python[1]}{python[2]}-cp{python[1]}{python[2]}-manylinux_{glibc[0]}_{glibc[1]}_x86_64"
        about = Path(work, f"driftwright-{version}.dist-info")
        write_licences(about / "licenses", {**libraries, **units}, [*HEADERS, "pybind11-dev"])
        shutil.copyfile(TOP / "LICENSE", about / "licenses/LICENSE")
        (about / "METADATA").write_text(
            f"Metadata-Version: 2.1\nName: driftwright\nVersion: {version}\nSummary: Digital twin of a machine tool's thermal behaviour\nLicense: GPL-3.0-or-later\n"
            f"Requires-Python: =={python[1]}.{python[2]}.*\nRequires-Dist: {numpy_wanted(build)}\nRequires-Dist: pandas\n")
        (about / "WHEEL").write_text(f"Wheel-Version: 1.0\nGenerator: driftwright bundle.py\nRoot-Is-Purelib: false\nTag: {tag}\n")
        (about / "entry_points.txt").write_text("[console_scripts]\ndriftwright = driftwright:main\n")
        target = out / f"driftwright-{version}-{tag}.whl"
        write_wheel([package, about], target, f"{about.name}/RECORD")
    print(f"{target}: {target.stat().st_size / 1e6:.1f} MB, {len(libraries)} libraries, glibc {glibc[0]}.{glibc[1]} or newer, processor {build.processor}")


def write_wheel(folders, target, record):
    partial = target.with_name(target.name + ".partial")
    lines = io.StringIO()
    listed = csv.writer(lines, lineterminator="\n")
    with zipfile.ZipFile(partial, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as packed:
        def add(name, data, mode):
            entry = zipfile.ZipInfo(name, time.gmtime(max(made_at(), 315532800))[:6])
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, (0o100000 | mode) << 16
            packed.writestr(entry, data)

        for path in [p for folder in folders for p in sorted(folder.rglob("*")) if p.is_file()]:
            data, name = path.read_bytes(), path.relative_to(folders[0].parent).as_posix()
            listed.writerow([name, "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).decode().rstrip("="), len(data)])
            add(name, data, 0o755 if ".so" in path.name else 0o644)
        listed.writerow([record, "", ""])
        add(record, lines.getvalue(), 0o644)
    partial.rename(target)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["archive", "wheel"])
    parser.add_argument("build", help="a folder that CMake has configured and built")
    parser.add_argument("out", help="folder of the result")
    asked = parser.parse_args()
    for tool, package in (("patchelf", "patchelf"), ("readelf", "binutils"), ("strip", "binutils"), ("dpkg-query", "dpkg")):
        needs(tool, package)
    out = Path(asked.out).resolve()
    out.mkdir(parents=True, exist_ok=True)
    (archive if asked.what == "archive" else wheel)(Build(asked.build), out)


main()
