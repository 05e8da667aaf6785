"""image_distance_test.py LODESTONE: what `distance --images` says of real pictures."""
import json
import pathlib
import subprocess
import sys
import tempfile


def run(*arguments):
    done = subprocess.run([sys.argv[1], *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{arguments}: exit code {done.returncode}: {done.stderr}")
    return done.stdout


def image_difference(reference, other):
    return json.loads(run("distance", reference, other, "--images", "--samples", 1000, "--json"))["image"]


def expect(condition, rule):
    if not condition:
        sys.exit(f"FAILED: {rule}")
    print(f"ok: {rule}")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    chair = folder / "chair.glb"
    run("generate", "chair", "-o", chair)
    lods = []
    for ratio in (0.6, 0.3, 0.1):
        lods.append(folder / f"lod_{ratio}.glb")
        run("simplify", chair, "-o", lods[-1], "--algorithm", "ias", "--ratio", ratio)

    same = image_difference(chair, chair)
    expect(same == {"cameras": 12, "flip": 0.0, "psnr": None, "ssim": 1.0}, "equal scenes look equal")
    differences = [image_difference(chair, lod) for lod in lods]
    flips = [difference["flip"] for difference in differences]
    expect(0.0 < flips[0] < flips[1] < flips[2] < 0.5, f"coarser LODs differ more: FLIP {flips}")
    similarities = [difference["ssim"] for difference in differences]
    expect(1.0 > similarities[0] > similarities[2] > 0.3, f"and are less similar: SSIM {similarities}")
    expect(differences[0] == image_difference(chair, lods[0]), "measuring twice gives the same numbers")
