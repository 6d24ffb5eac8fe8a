# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Tables and a plot of the measurements of benchmark.py."""

import statistics

SYSTEMS = ("Linear", "Contour", "Smooth")
CUBIC = ("CubicLocal", "CubicLeast")
DIRECTIONS = ("forward", "inverse")
PARTS = {
    "small": "{triangles} triangles, points row by row",
    "large, scan": "{triangles} triangles, points row by row, fewer points than triangles",
    "large, dense": "{triangles} triangles, points row by row, more points than triangles",
    "large, random": "{triangles} triangles, points in random order",
    "thin, grid": "{triangles} triangles of a grid, points in random order",
    "thin, fan": "{triangles} triangles of a fan, points in random order",
    "thin, slivers": "{triangles} triangles as long as the domain, points in random order",
    "threads": "{triangles} triangles, many points",
    "image": "warping an image",
    "construction": "preparation, per triangle",
}


class Results:
    def __init__(self, results):
        self.results = results
        self.times = {
            (part, m["name"], m["threads"]): [1e9 * s / m["points"] for s in m["seconds"]]
            for part, measurements in results["measurements"].items()
            for m in measurements
            if part not in ("construction", "cubic")
        }
        # By row and number of triangles: processor time, since these rows run for seconds.
        self.cubic = {
            (m["name"], m["points"]): statistics.median(m["processors"]) * 1e9 / m["points"]
            for m in results["measurements"].get("cubic", [])
        }
        self.construction = {
            (m["name"], m["threads"], m["points"]): [1e9 * s / m["points"] for s in m["seconds"]]
            for m in results["measurements"].get("construction", [])
        }

    def median(self, part, name, threads=1):
        times = self.times.get((part, name, threads))
        return statistics.median(times) if times else None

    def built(self, name, triangles, threads=1):
        times = self.construction.get((name, threads, triangles))
        return statistics.median(times) if times else None

    def sizes(self):
        return sorted({size for _, _, size in self.construction})


def number(value):
    return f"{value:.3g}" if value < 1000 else f"{value:,.0f}"


def goals(r):
    """Each goal as its description, the measured ratio, its limit, and whether it is reached."""
    found = []

    def add(words, value, peer, limit):
        """The value is at most limit times the peer's."""
        if value and peer:
            found.append((words, value / peer, "≤", limit, value / peer <= limit))

    def add_faster(words, value, peer, limit):
        if value and peer:
            found.append((words, peer / value, "≥", limit, peer / value >= limit))

    for d in DIRECTIONS:
        smooth = r.median("small", f"transform/Smooth/{d}")
        add(f"Smooth {d}, through the filter / SciPy LinearNDInterpolator", r.median("small", f"filter/Smooth/{d}"),
            r.median("small", f"LinearNDInterpolator/{d}"), 0.9)
        add(f"Smooth {d} / PROJ tinshift", smooth, r.median("small", f"tinshift/{d}"), 0.3)
        add(f"Contour {d} / SciPy CloughTocher2DInterpolator", r.median("small", f"transform/Contour/{d}"),
            r.median("small", f"CloughTocher2DInterpolator/{d}"), 1.0)
    for system in (*SYSTEMS, *CUBIC):
        add(f"{system} forward, point by point with the Jacobian / without", r.median("small", f"jacobian/{system}/forward"),
            r.median("small", f"pointwise/{system}/forward"), 1.3)
    for name in CUBIC:
        forward = r.median("small", f"transform/{name}/forward")
        add(f"{name} forward / Smooth forward", forward, r.median("small", "transform/Smooth/forward"), 1.0)
        add(f"{name} forward / SciPy CloughTocher2DInterpolator", forward,
            r.median("small", "CloughTocher2DInterpolator/forward"), 0.35)
        add(f"{name} inverse / forward", r.median("small", f"transform/{name}/inverse"), forward, 2.5)
    for d in DIRECTIONS:
        small = r.median("small", f"transform/Smooth/{d}")
        for part, words in (("large, dense", "more points than triangles"), ("large, scan", "fewer points than triangles")):
            add(f"Smooth {d}, large meshes row by row, {words} / small meshes",
                r.median(part, f"transform/Smooth/{d}"), small, 2.0)
        add(f"Smooth {d}, large meshes, random order / vtkStaticCellLocator::FindCell",
            r.median("large, random", f"transform/Smooth/{d}"), r.median("large, random", f"FindCell/{d}"), 1.0 / 3.0)
    for mesh in ("fan", "slivers"):
        for way in ("transform", "pointwise"):
            name = f"{way}/Smooth/forward"
            add(f"{name}, random points in {mesh} / in a grid", r.median(f"thin, {mesh}", name),
                r.median("thin, grid", name), 5.0)
    for system in SYSTEMS:
        for d in DIRECTIONS:
            name = f"transform/{system}/{d}"
            add_faster(f"{system} {d}, two threads faster than one", r.median("threads", name, 2), r.median("threads", name), 1.8)
    for way in ("resample", "reslice"):
        name = f"{way}/Smooth"
        words = {"resample": "vtkResampleThroughHomeomorphism", "reslice": "vtkImageReslice with Smooth"}[way]
        add_faster(f"image, {words} on two threads faster than scikit-image's piecewise affine warp",
                   r.median("image", name, 2), r.median("image", "warp/PiecewiseAffineTransform"), 25.0)
        add_faster(f"image, {words} on two threads faster than vtkImageReslice with a thin plate spline on two",
                   r.median("image", name, 2), r.median("image", "reslice/ThinPlateSpline", 2), 5.0)
    sizes = r.sizes()
    if sizes:
        last = sizes[-1]
        add(f"preparation, Smooth, {last:,} triangle pairs / vtkStaticCellLocator of one mesh",
            r.built("construct/Smooth", last), r.built("construct/vtkStaticCellLocator", last), 1.0)
        add(f"preparation per triangle, Smooth, {last:,} triangle pairs / {sizes[0]:,}",
            r.built("construct/Smooth", last), r.built("construct/Smooth", sizes[0]), 1.25)
        for system in SYSTEMS:
            kept = r.results["memory"][f"{system}/{last}"][0]
            found.append((f"bytes kept per triangle pair, {system}", kept, "≤", 400.0, kept <= 400.0))
    cubic_sizes = sorted({size for _, size in r.cubic})
    for name, time, space in (("CubicLocal", 3.0, 100.0), ("CubicLeast", 6.0, 500.0)):
        for size in cubic_sizes:
            add(f"preparation, {name} / Smooth, smooth displacement, {size:,} triangle pairs",
                r.cubic[f"construct/{name}", size], r.cubic["construct/Smooth", size], time)
            own, other = (r.results["cubic memory"][f"construct/{n}/{size}"][0] for n in (name, "Smooth"))
            found.append((f"bytes kept per triangle pair, {name} - Smooth, {size:,} triangle pairs", own - other, "≤",
                          space, own - other <= space))
        for fewer, more in zip(cubic_sizes, cubic_sizes[1:]):
            add(f"preparation per triangle, {name}, {more:,} triangle pairs / {fewer:,}",
                r.cubic[f"construct/{name}", more], r.cubic[f"construct/{name}", fewer], 1.25)
    add("Smooth forward / the affine map with the triangle known", r.median("small", "transform/Smooth/forward"),
        r.median("small", "affine/forward"), 9.0)
    return found


def agreement(checks):
    """A table of the comparisons between equivalent rows, by part, and a line for each comparison that failed."""
    lines = ["## Agreement", "", "Rows that compute the same, and points with their round trips. Tolerances are 1e-13 times the "
             "width of the domain, ten times that for round trips, nothing where bits must be equal, and a gray level for images.",
             "", "| | comparisons | equal bit for bit | largest share of the tolerance | too different |", "|---|---:|---:|---:|---:|"]
    for part in dict.fromkeys(check["part"] for check in checks):
        found = [check for check in checks if check["part"] == part]
        shares = [check["error"] / check["tolerance"] for check in found if check["tolerance"] > 0.0]
        lines.append(f"| {part} | {len(found)} | {sum(check['error'] == 0.0 for check in found)} | "
                     f"{max(shares, default=0.0):.2g} | {sum(not check['good'] for check in found)} |")
    lines += [""] + [f"**{check['part']}: {check['what']}: {check['error']:.2g}, but at most {check['tolerance']:.2g}**"
                     for check in checks if not check["good"]]
    return lines


def tables(results):
    r = Results(results)
    lines = ["# Benchmark", ""]
    if results["quick"]:
        lines += ["**A quick run, smaller and repeated less often: do not rely on its numbers.**", ""]
    lines += ["Medians of runs that took turns, on one machine. \"Processors\" is the number of processors that a row "
              "kept busy; a value below its number of threads means that other processes used them.", ""]
    lines += ["| goal | measured | limit | reached |", "|---|---:|---:|---|"]
    for words, value, relation, limit, good in goals(r):
        lines.append(f"| {words} | {number(value)} | {relation} {number(limit)} | {'yes' if good else '**no**'} |")
    lines.append("")
    for part, title in PARTS.items():
        measurements = results["measurements"].get(part)
        if not measurements or part == "construction":
            continue
        triangles = 2 * results["settings"][part.split(",")[0] if "," in part else "small"] ** 2
        lines += [f"## {title.format(triangles=f'{triangles:,}').capitalize()}", ""]
        lines += ["| | threads | points | ns per point | fastest and slowest run | runs | processors |",
                  "|---|---:|---:|---:|---:|---:|---:|"]
        rows = [(statistics.median(r.times[part, m["name"], m["threads"]]), m) for m in measurements]
        for median, m in sorted(rows, key=lambda row: row[0]):
            times = r.times[part, m["name"], m["threads"]]
            lines.append(f"| {m['name']} | {m['threads']} | {m['points']:,} | {number(median)} | "
                         f"{number(min(times))} to {number(max(times))} | {len(times)} | "
                         f"{sum(m['processors']) / sum(m['seconds']):.2f} |")
        lines.append("")
    if r.construction:
        lines += ["## Preparation", "", "Nanoseconds per triangle pair on one thread and on two; bytes per triangle pair "
                  "that are kept, and at the peak.", "", "| | triangles | ns | ns, two threads | bytes kept | bytes at peak |", "|---|---:|---:|---:|---:|---:|"]
        for size in r.sizes():
            for name in (*(f"construct/{s}" for s in SYSTEMS), "construct/vtkStaticCellLocator"):
                memory = results["memory"].get(f"{name.split('/')[1]}/{size}")
                kept, peak = (number(b) for b in memory) if memory else ("", "")
                lines.append(f"| {name.split('/')[1]} | {size:,} | {number(r.built(name, size))} | "
                             f"{number(r.built(name, size, 2))} | {kept} | {peak} |")
        lines.append("")
    if r.cubic:
        lines += ["## Preparation for a smooth displacement", "", "Nanoseconds of processor time per triangle pair; bytes "
                  "per triangle pair that are kept, and at the peak.", "",
                  "| | triangles | ns | bytes kept | bytes at peak |", "|---|---:|---:|---:|---:|"]
        for (name, size), time in r.cubic.items():
            kept, peak = results["cubic memory"][f"{name}/{size}"]
            lines.append(f"| {name.split('/')[1]} | {size:,} | {number(time)} | {number(kept)} | {number(peak)} |")
        lines.append("")
    lines += agreement(results["checks"])
    return "\n".join(lines) + "\n"


PEERS = (("LinearNDInterpolator", "SciPy LinearND (C⁰)"), ("tinshift", "PROJ tinshift (C⁰)"),
         ("FindCell", "VTK FindCell alone"), ("vtkProbeFilter", "VTK probe filter (C⁰)"),
         ("CloughTocher2DInterpolator", "SciPy CloughTocher (C¹, no inverse)"),
         ("PiecewiseAffineTransform", "scikit-image piecewise affine (C⁰)"),
         ("vtkThinPlateSplineTransform", "VTK thin plate spline (C¹)"))
OURS = (("transform/Linear", "Linear (C⁰)"), ("transform/Smooth", "Smooth (C², with its inverse)"),
        ("transform/Contour", "Contour (C⁰)"), ("transform/CubicLeast", "Cubic, least bending (C¹, with its inverse)"),
        ("transform/CubicLocal", "Cubic, local bending (C¹, with its inverse)"))
HIGHLIGHTED = ("transform/Smooth", "transform/CubicLeast")


def plot(results, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    r = Results(results)
    parts = [p for p in ("small", "large, scan", "large, random") if p in results["measurements"]]
    if not parts:
        return
    figure, axes = plt.subplots(1, len(parts), figsize=(5.6 * len(parts), 5.2), squeeze=False)
    for axis, part in zip(axes[0], parts):
        bars = []
        for name, label in (("affine", "affine map, triangle known"), *PEERS, *OURS):
            value = r.median(part, f"{name}/forward")
            if value:
                ours = name.startswith("transform")
                color = ("#1b6ca8" if name in HIGHLIGHTED else "#8fbcd9" if ours
                         else "#d8d8d8" if name == "affine" else "#c7a76c")
                bars.append((value, label, color, name in HIGHLIGHTED))
        bars.sort(key=lambda bar: bar[0], reverse=True)
        positions = range(len(bars))
        axis.barh(positions, [b[0] for b in bars], color=[b[2] for b in bars])
        axis.set_yticks(positions)
        axis.set_yticklabels([b[1] for b in bars], fontsize=9)
        for tick, bar in zip(axis.get_yticklabels(), bars):
            tick.set_fontweight("bold" if bar[3] else "normal")
        for position, bar in zip(positions, bars):
            axis.text(bar[0] * 1.08, position, number(bar[0]), va="center", fontsize=8.5, color="#444444")
        axis.set_xscale("log")
        axis.set_xlim(1.0, 20.0 * max(b[0] for b in bars))
        triangles = 2 * results["settings"]["large" if part.startswith("large") else "small"] ** 2
        axis.set_title(PARTS[part].format(triangles=f"{triangles:,}").replace(", fewer points than triangles", ""), fontsize=10)
        axis.set_xlabel("ns per point, forward, one thread (log scale)", fontsize=9)
        for side in ("top", "right"):
            axis.spines[side].set_visible(False)
        axis.grid(axis="x", color="#eeeeee")
        axis.set_axisbelow(True)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def write(results, folder):
    text = tables(results)
    (folder / "benchmark.md").write_text(text)
    plot(results, folder / "benchmark.png")
    print(text)
