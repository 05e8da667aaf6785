"""readme_test.py LODESTONE README: every command line that the README shows works, said of the chair:
the tree takes minutes."""
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

binary, readme = sys.argv[1:3]
blocks = re.findall(r"^```sh\n(.*?)^```", pathlib.Path(readme).read_text(), re.S | re.M)
lines = [line for block in blocks for line in block.splitlines() if line.startswith("lodestone ")]
if len(lines) < 5:
    sys.exit(f"FAILED: only {len(lines)} command lines were found in {readme}")

with tempfile.TemporaryDirectory() as folder:
    for line in (line.replace("maple", "chair") for line in lines):
        arguments = shlex.split(line, comments=True)[1:]
        done = subprocess.run([binary, *arguments], cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"FAILED: {line}: exit code {done.returncode}: {done.stderr}")
        print(f"ok: {line}")
    written = {path.name for path in pathlib.Path(folder).iterdir()}
    named = set(re.findall(r"[\w-]+\.(?:glb|png|html|csv)", " ".join(lines).replace("maple", "chair")))
    if not named <= written:
        sys.exit(f"FAILED: not written: {sorted(named - written)}")
