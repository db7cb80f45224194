#!/usr/bin/env python3
"""Photometric files of `catoptric intensity` as programs of other people read them.

independent_readers.py PROGRAM

A lamp that is alike all round and one that is not are written as IES and EULUMDAT, read by whichever of these is
installed, and held against intensity.csv:
  Radiance   ies2rad, oconv, rtrace on PATH, its library on RAYPATH: illuminance 100 m away, times the distance squared
  pyldt      Python package eulumdat-py on PYTHONPATH: the table of an EULUMDAT file
Ends with 77 (skipped) where none of them is, with 1 where a number is farther off than its reader's own rounding.
"""
import csv
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

LAMPS = {
    "round": 'source.kind = "disc"\nsource.radius = 1\nsource.position = [0, 0, 5]\n',
    "aside": 'source.kind = "disc"\nsource.radius = 1\nsource.position = [1.5, 0.5, 5]\nsource.axis = [1, 0, 1]\n',
}
SCENE = """unit = "cm"
title = "Independent reader"
source.flux = 800
reflector.points = [[0, 10], [5, 10], [10, 5]]
reflector.reflectance = 0.9
near_field.radius = 5
model.photons = 200000
intensity.c_step = 15
intensity.gamma_step = 2.5
"""
# ies2rad writes six digits, rtrace computes and answers in single precision.
RADIANCE_REL = 1e-4
# EULUMDAT has cd per 1000 lm, in text that comes back to the bit.
EULUMDAT_REL = 1e-12


def write_lamp(program, folder, name):
    with open(f"{folder}/{name}.toml", "w", encoding="utf-8") as file:
        file.write(SCENE + LAMPS[name])
    out = f"{folder}/{name}"
    subprocess.run([program, "intensity", f"{folder}/{name}.toml", "--out", out, "--quiet"], check=True)
    with open(f"{out}/intensity.csv", encoding="utf-8") as file:
        rows = [list(map(float, row[:3])) for row in list(csv.reader(file))[1:]]
    with open(f"{out}/intensity.json", encoding="utf-8") as file:
        flux = json.load(file)["flux"]["value"]
    return out, {(gamma, c): value for gamma, c, value in rows}, flux


def greatest_difference(table, found):
    """Over the table's greatest value, so that dark directions do not count more than they light."""
    top = max(table.values())
    return max(abs(found[key] - value) for key, value in table.items()) / top


def by_radiance(out, directions):
    """Candela in each (gamma, C) by the illuminance that it makes far away."""
    subprocess.run(["ies2rad", "-o", "lamp", "luminaire.ies"], cwd=out, check=True, stderr=subprocess.DEVNULL)
    with open(f"{out}/lamp.oct", "wb") as octree:
        subprocess.run(["oconv", "lamp.rad"], cwd=out, check=True, stdout=octree)
    distance_m, lm_per_w = 100.0, 179.0
    lines = []
    for gamma, c in directions:
        g, a = math.radians(gamma), math.radians(c)
        to = (math.sin(g) * math.cos(a), math.sin(g) * math.sin(a), -math.cos(g))
        lines.append(" ".join(f"{distance_m * x:.9f}" for x in to) + " " + " ".join(f"{-x:.9f}" for x in to))
    # rtrace looks for the table on this path alone.
    environment = dict(os.environ, RAYPATH=os.environ["RAYPATH"] + ":.")
    answer = subprocess.run(["rtrace", "-h", "-I", "-ab", "0", "-dj", "0", "-ds", "0", "lamp.oct"], cwd=out, check=True,
                            env=environment, input="\n".join(lines), capture_output=True, text=True)
    found = {}
    for key, line in zip(directions, answer.stdout.splitlines()):
        red, green, blue = map(float, line.split())
        found[key] = lm_per_w * (0.265 * red + 0.670 * green + 0.065 * blue) * distance_m ** 2
    return found


def neighbours(values, at, period=None):
    """The two values about a number, and its share of the way between them."""
    low = max(value for value in values if value <= at)
    above = [value for value in values if value > at]
    high = above[0] if above else (period if period else low)
    return low, high % period if period else high, (at - low) / (high - low) if high != low else 0


def bilinear(table, gamma, c):
    gammas, planes = (sorted({key[i] for key in table}) for i in (0, 1))
    g0, g1, g = neighbours(gammas, gamma)
    if len(planes) == 1:
        return (1 - g) * table[g0, planes[0]] + g * table[g1, planes[0]]
    c0, c1, k = neighbours(planes, c, 360)
    return (1 - k) * ((1 - g) * table[g0, c0] + g * table[g1, c0]) + k * ((1 - g) * table[g0, c1] + g * table[g1, c1])


def between(table):
    """Directions in the middles of the table's cells."""
    gammas, planes = (sorted({key[i] for key in table}) for i in (0, 1))
    step = 360 / len(planes)
    return [(0.5 * (a + b), c + 0.5 * step) for a, b in zip(gammas, gammas[1:]) for c in planes]


def flux_of(found):
    """Lumens of intensities on a regular grid: each for the solid angle up to half way to its neighbours."""
    gammas = sorted({gamma for gamma, _ in found})
    planes = sorted({c for _, c in found})
    flux = 0
    for i, gamma in enumerate(gammas):
        low = 0.5 * (gamma + gammas[max(i - 1, 0)])
        high = 0.5 * (gamma + gammas[min(i + 1, len(gammas) - 1)])
        band = 2 * math.pi * (math.cos(math.radians(low)) - math.cos(math.radians(high)))
        flux += band * sum(found[gamma, c] for c in planes) / len(planes)
    return flux


def radiance_is_here():
    return all(shutil.which(tool) for tool in ("ies2rad", "oconv", "rtrace")) and "RAYPATH" in os.environ


def pyldt_or_none():
    try:
        import pyldt
        return pyldt
    except ImportError:
        return None


def main():
    program = os.path.abspath(sys.argv[1])
    pyldt = pyldt_or_none()
    if not radiance_is_here() and not pyldt:
        print("skipped: neither Radiance (with RAYPATH) nor the Python package eulumdat-py is installed")
        return 77
    bad = 0

    def verdict(reader, lamp, count, difference, allowed):
        nonlocal bad
        bad += not difference <= allowed
        print(f"{reader}, {lamp}: {count} intensities, off by {difference:.1e} of the greatest at most "
              f"({allowed:g} allowed)")

    with tempfile.TemporaryDirectory() as folder:
        for lamp in LAMPS:
            out, table, flux = write_lamp(program, folder, lamp)
            if radiance_is_here():
                # Radiance makes the opening a flat disc, which has no light edge on.
                found = by_radiance(out, [key for key in table if key[0] != 90] + between(table))
                wanted = {key: bilinear(table, *key) for key in found}
                verdict("Radiance, IES", lamp, len(found), greatest_difference(wanted, found), RADIANCE_REL)
                found = {key: found.get(key, value) for key, value in table.items()}
                ours, theirs = flux_of(table), flux_of(found)
                print(f"    flux: {theirs:.4f} lm by Radiance, {ours:.4f} lm of our table by the same sum "
                      f"({flux:.4f} lm left the lamp)")
                turned = {key: found.get((key[0], (key[1] + 90) % 360), found[key]) for key in found}
                if lamp == "aside" and greatest_difference(table, turned) < 100 * RADIANCE_REL:
                    bad += 1
                    print("    a table turned by 90 degrees was not noticed")
            if pyldt:
                ldt = pyldt.LdtReader.read(f"{out}/luminaire.ldt")
                lamp_lm = ldt.header.lamp_flux[0]
                found = {(gamma, c): ldt.intensities[i][k] * lamp_lm / 1000
                         for i, c in enumerate(ldt.header.c_angles)
                         for k, gamma in enumerate(ldt.header.g_angles)}
                if lamp == "round":
                    table = {(gamma, c): table[gamma, 0.0] for gamma, c in found}
                if set(found) != set(table):
                    bad += 1
                    print("pyldt: other angles than ours")
                    continue
                verdict("eulumdat-py", lamp, len(found), greatest_difference(table, found), EULUMDAT_REL)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
