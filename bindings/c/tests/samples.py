"""The samples of a page compile word for word, in order of their languages, where a compiler is installed.

python3 samples.py PAGE PREFIX
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
UNITY = HERE.parents[2] / "engines/unity"


# Around a few calls that stand alone on a page.
FRAME = """#include <strew.h>
void sample(strew_library *library, strew_plan *plan, uint64_t count, double *xyz, double *turns);
void sample(strew_library *library, strew_plan *plan, uint64_t count, double *xyz, double *turns) {{
{}}}
"""


def run(*command: object) -> None:
    subprocess.run([str(word) for word in command], check=True)


def compiled(language: str, code: str, folder: Path, prefix: Path) -> bool:
    """Compiles a sample; False without a compiler for its language."""
    if language == "cpp" and shutil.which("g++"):
        file = folder / "sample.cpp"
        file.write_text(code if "#include" in code else f"#include <strew.hpp>\nvoid sample() {{\n{code}}}\n")
        # The engine's headers are stubs in tests/unreal.
        run("g++", "-std=c++17", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function", "-fsyntax-only",
            f"-I{prefix}/include", f"-I{HERE}/unreal", file)
    elif language == "c" and shutil.which("gcc"):
        file = folder / "sample.c"
        flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", f"-I{prefix}/include"]
        if "main" not in code:
            file.write_text(FRAME.format(code))
            run("gcc", *flags, "-fsyntax-only", file)
            return True
        file.write_text(code)
        run("gcc", *flags, file, f"-L{prefix}/lib", "-lstrew", "-o", folder / "sample")
        run(folder / "sample")
    elif language == "cmake" and shutil.which("cmake"):
        # A project of the page's sample in C.
        (folder / "CMakeLists.txt").write_text(code)
        run("cmake", "-S", folder, "-B", folder / "built", f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release")
        run("cmake", "--build", folder / "built")
        run(folder / "built/points")
    elif language == "csharp" and "PublicIncludePaths" in code:
        # Lines of a file that Unreal's build tool reads.
        return False
    elif language == "csharp" and shutil.which("mcs"):
        file = folder / "sample.cs"
        file.write_text(code)
        run("mcs", "-langversion:7", "-warnaserror", "-target:library", f"-out:{folder}/sample.dll", file,
            *UNITY.glob("Runtime/*.cs"), UNITY / "test/Engine.cs")
    elif language == "js" and shutil.which("node"):
        file = folder / "sample.mjs"
        file.write_text(code)
        run("node", "--check", file)
    elif language == "python":
        compile(code, "the sample", "exec")
    elif language == "gdscript" and shutil.which("gdparse"):
        file = folder / "sample.gd"
        file.write_text(code)
        run("gdparse", file)
    else:
        return False
    return True


def main() -> None:
    page, prefix = Path(sys.argv[1]), Path(sys.argv[2]).resolve()
    blocks = re.findall(r"^```(\w+)\n(.*?)^```$", page.read_text(), re.M | re.S)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        c = [code for language, code in blocks if language == "c"]
        if c:
            (folder / "points.c").write_text(c[0])
        for language, code in blocks:
            if language in ("sh", "text"):
                continue
            done = compiled(language, code, folder, prefix)
            print(f"{page.name}: {language} {'compiles' if done else 'skipped: no compiler for it here'}")


main()
