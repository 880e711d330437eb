#!/usr/bin/python3
"""Pictures of meshes: the surface with its edges, and a cut-away view of the tets coloured by quality.

    xvfb-run -a testdata/gallery/render.py MESH... -o picture.png [--cut x|y|z|nx,ny,nz] [--from anterior|...|x,y,z]
                                           [--histogram] [--columns N]

Needs Debian's python3-vtk9 and xvfb, nothing else. Views assume RAS coordinates (+x right, +y front, +z up of the
patient); a mesh in another frame wants --from x,y,z. With --cut the tets whose centroid lies beyond the plane are
taken away, whole tets only; the faces laid open show each tet's smallest dihedral angle. --histogram adds one of the
triangles' radius-edge ratios, as in figure 14.7 of the book: 1 is what angles of at least 30 degrees allow. Several
meshes stand side by side, each in a picture of --size.
"""
import argparse
import os
import struct
import sys
import zlib

import vtk

DIRECTIONS = {  # where the camera stands, seen from the middle of the mesh
    "anterior": (0, 1, 0), "posterior": (0, -1, 0), "right": (1, 0, 0), "left": (-1, 0, 0),
    "superior": (0, 0.001, 1), "inferior": (0, 0.001, -1), "three-quarter": (0.75, 1, 0.35)}
BONE = (0.90, 0.87, 0.80)
BACKGROUND = (1, 1, 1)
HISTOGRAM = 0.3  # share of the picture's height that a histogram takes
LEAST_RATIO, LAST_RATIO, BARS = 3 ** -0.5, 2.0, 40  # of an equilateral triangle; one more bar holds all beyond
READERS = {".vtu": vtk.vtkXMLUnstructuredGridReader, ".vtk": vtk.vtkDataSetReader, ".stl": vtk.vtkSTLReader,
           ".ply": vtk.vtkPLYReader, ".obj": vtk.vtkOBJReader}


def vector(text):
    if text in DIRECTIONS:
        return DIRECTIONS[text]
    if text in ("x", "y", "z"):
        return tuple(float(text == axis) for axis in "xyz")
    parts = tuple(float(part) for part in text.split(","))
    if len(parts) != 3 or not any(parts):
        raise argparse.ArgumentTypeError("three numbers or a name: " + ", ".join(DIRECTIONS))
    return parts


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+", metavar="MESH")
    parser.add_argument("--columns", type=int, help="how many meshes to a row (default: all)")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--from", dest="eye", type=vector, default=DIRECTIONS["three-quarter"])
    parser.add_argument("--up", type=vector, default=(0, 0, 1))
    parser.add_argument("--cut", type=vector, help="take away what lies on this side of the plane")
    parser.add_argument("--at", type=float, default=0.5, help="where the plane lies along its normal, 0 to 1")
    parser.add_argument("--size", default="1000x800")
    parser.add_argument("--no-edges", action="store_true")
    parser.add_argument("--histogram", action="store_true", help="of the triangles' radius-edge ratios, below")
    parser.add_argument("--colours", type=int, default=192, help="of the PNG's palette")
    return parser.parse_args()


def read(path):
    reader = READERS[os.path.splitext(path)[1].lower()]()
    reader.SetFileName(path)
    reader.Update()
    mesh = reader.GetOutput()
    if mesh.GetNumberOfCells() == 0:
        sys.exit("render.py: " + path + ": nothing to show")
    return mesh


def cells_of(mesh, vtk_type):
    """The tets, or the triangles, of an unstructured grid."""
    wanted = vtk.vtkIdList()
    for i in range(mesh.GetNumberOfCells()):
        if mesh.GetCellType(i) == vtk_type:
            wanted.InsertNextId(i)
    extract = vtk.vtkExtractCells()
    extract.SetInputData(mesh)
    extract.SetCellList(wanted)
    extract.Update()
    return extract.GetOutput()


def surface_of(mesh):
    """Boundary triangles; their corners and cells know the ids they have in `mesh`."""
    geometry = vtk.vtkGeometryFilter()
    geometry.SetInputData(mesh)
    geometry.PassThroughPointIdsOn()
    geometry.PassThroughCellIdsOn()
    geometry.SetOriginalPointIdsName("point")
    geometry.SetOriginalCellIdsName("cell")
    geometry.Update()
    return geometry.GetOutput()


def faces_of(surface, name):
    """Per triangle, the ids of its corners in the mesh that the array `name` refers to."""
    ids = surface.GetPointData().GetArray(name)
    corners = vtk.vtkIdList()
    for i in range(surface.GetNumberOfCells()):
        surface.GetCellPoints(i, corners)
        yield frozenset(int(ids.GetTuple1(corners.GetId(k))) for k in range(corners.GetNumberOfIds()))


def smallest_dihedrals(tets):
    quality = vtk.vtkMeshQuality()
    quality.SetInputData(tets)
    quality.SetTetQualityMeasureToMinAngle()
    quality.Update()
    return quality.GetOutput().GetCellData().GetArray("Quality")


def cut_open(tets, normal, at):
    """Surface of the tets left of the plane; `shown` is the smallest dihedral where cut, not a number elsewhere."""
    numbers = vtk.vtkIdTypeArray()
    numbers.SetName("whole")
    for i in range(tets.GetNumberOfPoints()):
        numbers.InsertNextValue(i)
    tets.GetPointData().AddArray(numbers)
    outer = set(faces_of(surface_of(tets), "point"))
    dihedral = smallest_dihedrals(tets)
    dihedral.SetName("dihedral")
    tets.GetCellData().AddArray(dihedral)

    bounds = tets.GetBounds()
    low, high = bounds[0::2], bounds[1::2]
    corners = [sum(n * (h if n * side > 0 else l) for n, l, h in zip(normal, low, high)) for side in (-1, 1)]
    level = corners[0] + at * (corners[1] - corners[0])
    centers = vtk.vtkCellCenters()
    centers.SetInputData(tets)
    centers.Update()
    kept = vtk.vtkIdList()
    for i in range(tets.GetNumberOfCells()):
        if sum(n * x for n, x in zip(normal, centers.GetOutput().GetPoint(i))) < level:
            kept.InsertNextId(i)
    extract = vtk.vtkExtractCells()
    extract.SetInputData(tets)
    extract.SetCellList(kept)
    extract.Update()

    surface = surface_of(extract.GetOutput())
    shown = vtk.vtkFloatArray()
    shown.SetName("shown")
    value = surface.GetCellData().GetArray("dihedral")
    for i, face in enumerate(faces_of(surface, "whole")):
        shown.InsertNextValue(float("nan") if face in outer else value.GetTuple1(i))
    surface.GetCellData().SetScalars(shown)
    return surface


def colours():
    """Smallest dihedral angle, degrees: red is bad, blue is good."""
    transfer = vtk.vtkColorTransferFunction()
    for degrees, rgb in ((0, (0.70, 0.05, 0.10)), (15, (0.95, 0.55, 0.25)), (30, (0.98, 0.90, 0.55)),
                         (45, (0.50, 0.75, 0.80)), (70, (0.15, 0.35, 0.65))):
        transfer.AddRGBPoint(degrees, *rgb)
    transfer.SetNanColor(*BONE)
    return transfer


def actor_of(surface, edges, lookup):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.ScalarVisibilityOff()
    if lookup:
        mapper.SetLookupTable(lookup)
        mapper.SetScalarModeToUseCellData()
        mapper.ScalarVisibilityOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    shading = actor.GetProperty()
    shading.SetColor(*BONE)
    shading.SetInterpolationToFlat()
    shading.SetAmbient(0.25)
    shading.SetDiffuse(0.8)
    shading.SetEdgeVisibility(edges)
    shading.SetEdgeColor(0.25, 0.25, 0.28)
    shading.SetLineWidth(0.6)
    inside = vtk.vtkProperty()  # back faces stand out: on a closed, outward mesh none is ever seen
    inside.DeepCopy(shading)
    inside.SetColor(0.9, 0.1, 0.7)
    actor.SetBackfaceProperty(inside)
    return actor


def legend(lookup):
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(lookup)
    bar.SetTitle("smallest\ndihedral, deg\n")
    bar.SetNumberOfLabels(8)
    bar.SetLabelFormat("%.0f")
    bar.SetUnconstrainedFontSize(True)
    for style in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        style.SetColor(0.1, 0.1, 0.1)
        style.ShadowOff()
        style.ItalicOff()
        style.BoldOff()
        style.SetFontSize(15)
    bar.SetPosition(0.89, 0.25)
    bar.SetWidth(0.08)
    bar.SetHeight(0.5)
    return bar


def radius_edge(p, q, r):
    """Circumradius over shortest edge of a triangle."""
    sides = [sum((a - b) ** 2 for a, b in zip(u, v)) ** 0.5 for u, v in ((p, q), (q, r), (r, p))]
    half = sum(sides) / 2
    area = max(half * (half - sides[0]) * (half - sides[1]) * (half - sides[2]), 0) ** 0.5
    return sides[0] * sides[1] * sides[2] / (4 * area) / min(sides) if area > 0 else float("inf")


def ratios_of(surface):
    corners = vtk.vtkIdList()
    for i in range(surface.GetNumberOfCells()):
        surface.GetCellPoints(i, corners)
        if corners.GetNumberOfIds() == 3:
            yield radius_edge(*(surface.GetPoint(corners.GetId(k)) for k in range(3)))


def rectangle(left, bottom, right, top, rgb):
    """A filled rectangle, in shares of the picture."""
    plane = vtk.vtkPlaneSource()
    plane.SetOrigin(left, bottom, 0)
    plane.SetPoint1(right, bottom, 0)
    plane.SetPoint2(left, top, 0)
    place = vtk.vtkCoordinate()
    place.SetCoordinateSystemToNormalizedViewport()
    mapper = vtk.vtkPolyDataMapper2D()
    mapper.SetInputConnection(plane.GetOutputPort())
    mapper.SetTransformCoordinate(place)
    actor = vtk.vtkActor2D()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*rgb)
    return actor


def caption(text, x, y, size):
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(x, y)
    style = actor.GetTextProperty()
    style.SetColor(0.1, 0.1, 0.1)
    style.SetFontSize(size)
    style.SetJustificationToCentered()
    return actor


def histogram(surface, height):
    """Bars of the triangles' radius-edge ratios along the lower edge of a picture of that height; those above 1 red."""
    counts = [0] * (BARS + 1)
    for ratio in ratios_of(surface):
        place = (ratio - LEAST_RATIO) / (LAST_RATIO - LEAST_RATIO)
        counts[min(int(place * BARS), BARS) if place < 1 else BARS] += 1
    left, right, floor, top = 0.08, 0.92, 0.09, HISTOGRAM - 0.02
    step = (right - left) / (BARS + 1)
    size = max(11, round(height / 32))
    actors = [rectangle(left, floor - 0.002, right, floor, (0.3, 0.3, 0.3))]
    for i, count in enumerate(counts):
        bad = LEAST_RATIO + i * (LAST_RATIO - LEAST_RATIO) / BARS >= 1
        tall = floor + (top - floor) * count / max(counts)
        if count:  # at least a line, so that a single triangle shows
            actors.append(rectangle(left + (i + 0.08) * step, floor, left + (i + 0.92) * step, max(tall, floor + 0.004),
                                    (0.75, 0.15, 0.15) if bad else (0.25, 0.45, 0.7)))
    for ratio in (0.6, 1.0, 1.5):
        x = left + (ratio - LEAST_RATIO) / (LAST_RATIO - LEAST_RATIO) * BARS * step
        actors.append(caption("%g" % ratio, x, floor - 0.045, size))
    actors.append(caption("2 and more", right - 0.05, floor - 0.045, size))
    actors.append(caption("circumradius / shortest edge of %d triangles" % sum(counts), 0.5, 0.005, size))
    return actors


def aim(camera, points, options, aspect, right_margin):
    """Looks from options.eye so that the points fill the picture but for margins (shares of its width)."""
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*options.eye)
    camera.SetViewUp(*options.up)
    camera.OrthogonalizeViewUp()
    to_view = camera.GetViewTransformMatrix()
    axes = [[to_view.GetElement(row, column) for column in range(3)] for row in range(3)]
    low, high = [float("inf")] * 3, [-float("inf")] * 3
    for i in range(points.GetNumberOfPoints()):
        point = points.GetPoint(i)
        for k, axis in enumerate(axes):
            x = axis[0] * point[0] + axis[1] * point[1] + axis[2] * point[2]
            low[k], high[k] = min(low[k], x), max(high[k], x)
    width, height, depth = (h - l for l, h in zip(low, high))
    margin = 0.03
    below = HISTOGRAM if options.histogram else 0
    scale = max(height / (1 - 2 * margin - below), width / (1 - 2 * margin - right_margin) / aspect) / 2
    middle = [(l + h) / 2 for l, h in zip(low, high)]
    middle[0] += right_margin * scale * aspect
    middle[1] -= below * scale
    focus = [sum(axes[k][c] * middle[k] for k in range(3)) for c in range(3)]
    camera.SetFocalPoint(*focus)
    camera.SetPosition(*(f + 2 * (depth + scale) * axes[2][c] for c, f in enumerate(focus)))
    camera.SetParallelScale(scale)


def shoot(surface, actors, options, right_margin):
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(*BACKGROUND)
    for actor in actors:
        renderer.AddViewProp(actor)
    window = vtk.vtkRenderWindow()
    window.OffScreenRenderingOn()
    window.SetMultiSamples(8)
    window.SetSize(*(int(part) for part in options.size.split("x")))
    window.AddRenderer(renderer)
    width, height = window.GetSize()
    aim(renderer.GetActiveCamera(), surface, options, width / height, right_margin)
    renderer.ResetCameraClippingRange()
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    window.Finalize()  # X servers have only so many windows
    return grab.GetOutput()


def write_palette_png(image, count, path):
    """A PNG of few colours: a third of the size of one in full colour."""
    quantize = vtk.vtkImageQuantizeRGBToIndex()
    quantize.SetInputData(image)
    quantize.SetNumberOfColors(count)
    quantize.Update()
    indices, table = quantize.GetOutput(), quantize.GetLookupTable()
    width, height, _ = indices.GetDimensions()
    numbers = vtk.vtkImageCast()
    numbers.SetInputData(indices)
    numbers.SetOutputScalarTypeToUnsignedChar()
    numbers.Update()
    data = bytes(memoryview(numbers.GetOutput().GetPointData().GetScalars()))
    rows = b"".join(b"\0" + data[y * width:(y + 1) * width] for y in range(height - 1, -1, -1))
    palette = bytes(round(255 * c) for i in range(count) for c in table.GetTableValue(i)[:3])

    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    header = struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"PLTE", palette) +
                  chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def picture_of(path, options):
    mesh = read(path)
    lookup = None
    if options.cut:
        surface = cut_open(cells_of(mesh, vtk.VTK_TETRA), options.cut, options.at)
        lookup = colours()
    elif mesh.IsA("vtkUnstructuredGrid"):
        tets = cells_of(mesh, vtk.VTK_TETRA)
        surface = surface_of(tets if tets.GetNumberOfCells() else mesh)
    else:
        surface = mesh
    actors = [actor_of(surface, not options.no_edges, lookup)]
    if lookup and len(options.meshes) == 1:  # there is no room for one in each of several
        actors.append(legend(lookup))
    if options.histogram:
        actors += histogram(surface, int(options.size.split("x")[1]))
    print("%s: %d triangles shown" % (path, surface.GetNumberOfCells()))
    return shoot(surface, actors, options, 0.12 if lookup and len(options.meshes) == 1 else 0)


def joined(images, axis):
    """Images side by side (axis 0) or, the first on top, one above the other (axis 1)."""
    append = vtk.vtkImageAppend()
    append.SetAppendAxis(axis)
    for image in images if axis == 0 else reversed(images):
        append.AddInputData(image)
    append.Update()
    return append.GetOutput()


def main():
    options = parse_arguments()
    images = [picture_of(path, options) for path in options.meshes]
    columns = options.columns or len(images)
    if len(images) % columns != 0:
        sys.exit("render.py: %d meshes do not fill rows of %d" % (len(images), columns))
    rows = [joined(images[i:i + columns], 0) for i in range(0, len(images), columns)]
    write_palette_png(joined(rows, 1), options.colours, options.output)
    print("%s: %.0f kB" % (options.output, os.path.getsize(options.output) / 1000))


if __name__ == "__main__":
    main()
