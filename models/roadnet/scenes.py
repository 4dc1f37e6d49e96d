"""A georeferenced picture with road lines as a pair: both in one UTM grid of square pixels. Needs GDAL for Python."""
import cv2
import numpy as np
from osgeo import gdal, osr

from .data import Level

gdal.UseExceptions()


class Scene:
    """What evaluation asks of a data.Pair; the truth are lines of one pixel."""

    def __init__(self, name, picture, lines, gsd_m=0.5):
        self.set_name = self.name = name
        self.lines = True
        grid = gdal.Warp("", str(picture), format="MEM", dstSRS=f"EPSG:{utm_zone(picture)}", xRes=gsd_m, yRes=gsd_m,
                         dstAlpha=True, resampleAlg="bilinear")
        bands = [grid.GetRasterBand(number + 1).ReadAsArray() for number in range(grid.RasterCount)]
        self.seen = bands[-1] > 127
        self.truth = drawn(lines, grid) & self.seen
        self.levels = [Level(gsd_m, np.dstack(bands[:3]).astype(np.uint8), self.truth * np.uint8(255), self.seen * np.uint8(255))]


def utm_zone(picture):
    source = gdal.Open(str(picture))
    west, step, _, north, _, down = source.GetGeoTransform()
    degrees = osr.SpatialReference()
    degrees.ImportFromEPSG(4326)
    degrees.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    place = osr.CoordinateTransformation(source.GetSpatialRef(), degrees).TransformPoint(
        west + step * source.RasterXSize / 2, north + down * source.RasterYSize / 2)
    return (32600 if place[1] >= 0 else 32700) + int((place[0] + 180) // 6) + 1


def drawn(lines, grid):
    """The lines as pixels of the grid."""
    there = gdal.GetDriverByName("MEM").Create("", grid.RasterXSize, grid.RasterYSize, 1, gdal.GDT_Byte)
    there.SetGeoTransform(grid.GetGeoTransform())
    there.SetProjection(grid.GetProjection())
    moved = gdal.VectorTranslate("", str(lines), format="Memory", dstSRS=grid.GetProjection(), dim="XY")
    gdal.RasterizeLayer(there, [1], moved.GetLayer(), burn_values=[1], options=["ALL_TOUCHED=TRUE"])
    return cv2.dilate(there.ReadAsArray(), np.ones((3, 3), np.uint8)) > 0
