"""Cuts frames at known poses out of a georeferenced image, as a camera that looks straight down would see them."""
import math
import random

from osgeo import gdal, osr

gdal.UseExceptions()
osr.UseExceptions()
FOOTPRINT_M = 600
LARGEST_SHARE = 0.6  # of the shorter side of the image, so that there is room to turn
TRIES_PER_FRAME = 200


def utm_of(lat, lon):
    zone = min(60, int((lon + 180) // 6) + 1)
    system = osr.SpatialReference()
    system.ImportFromEPSG((32600 if lat >= 0 else 32700) + zone)
    system.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return system


def geographic():
    system = osr.SpatialReference()
    system.ImportFromEPSG(4326)
    system.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return system


def grid_bearing_of_true_north_deg(to_utm, lat, lon):
    east_0, north_0, _ = to_utm.TransformPoint(lon, lat)
    east_1, north_1, _ = to_utm.TransformPoint(lon, lat + 1e-4)
    return math.degrees(math.atan2(east_1 - east_0, north_1 - north_0))


def rotated_geotransform(east, north, grid_heading_deg, gsd_m, size_px):
    """Row 0 is the forward edge, columns run to the right of travel, the centre of the frame lies at (east, north)."""
    heading = math.radians(grid_heading_deg)
    right = (math.cos(heading) * gsd_m, -math.sin(heading) * gsd_m)
    back = (-math.sin(heading) * gsd_m, -math.cos(heading) * gsd_m)
    half = size_px / 2
    return (east - half * (right[0] + back[0]), right[0], back[0], north - half * (right[1] + back[1]), right[1], back[1])


def warped_frame(source, utm, geotransform, size_px):
    """The frame's bands with an alpha band, or None where the image does not cover it."""
    bands = source.RasterCount
    frame = gdal.GetDriverByName("MEM").Create("", size_px, size_px, bands + 1, gdal.GDT_Byte)
    frame.SetProjection(utm.ExportToWkt())
    frame.SetGeoTransform(geotransform)
    frame.GetRasterBand(bands + 1).SetColorInterpretation(gdal.GCI_AlphaBand)
    gdal.Warp(frame, source, resampleAlg="cubic")
    covered = frame.GetRasterBand(bands + 1).ReadAsArray()
    return frame if (covered > 0).mean() > 0.99 else None


def open_image(image):
    """Its first three bands, or the first one, as bytes."""
    source = gdal.Open(str(image))
    if not source.GetProjection():
        raise ValueError(f"{image} has no georeference to take the truth from")
    bands = [1, 2, 3] if source.RasterCount >= 3 else [1]
    if source.GetRasterBand(1).DataType == gdal.GDT_Byte:
        return gdal.Translate("", source, format="VRT", bandList=bands)
    return gdal.Translate("", source, format="VRT", bandList=bands, outputType=gdal.GDT_Byte, scaleParams=[[]])


def cut_frames(image, folder, count, seed):
    """Writes `count` PNG files and returns (file, gsd_m, (lat, lon, heading_deg)) of each."""
    source = open_image(image)
    own = source.GetSpatialRef()
    own.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    to_geographic = osr.CoordinateTransformation(own, geographic())
    origin = source.GetGeoTransform()
    generator = random.Random(seed)
    folder.mkdir(parents=True, exist_ok=True)
    frames = []
    for _ in range(count * TRIES_PER_FRAME):
        if len(frames) == count:
            return frames
        column, row = generator.random() * source.RasterXSize, generator.random() * source.RasterYSize
        lon, lat, _ = to_geographic.TransformPoint(*gdal.ApplyGeoTransform(origin, column, row))
        utm = utm_of(lat, lon)
        to_utm = osr.CoordinateTransformation(geographic(), utm)
        east, north, _ = to_utm.TransformPoint(lon, lat)
        gsd_m = ground_size_m(source, to_geographic, to_utm, column, row)
        size_px = min(round(FOOTPRINT_M / gsd_m), int(LARGEST_SHARE * min(source.RasterXSize, source.RasterYSize)))
        heading = generator.random() * 360
        grid_heading = heading + grid_bearing_of_true_north_deg(to_utm, lat, lon)
        frame = warped_frame(source, utm, rotated_geotransform(east, north, grid_heading, gsd_m, size_px), size_px)
        if frame is not None:
            file = folder / f"frame_{len(frames) + 1:02}.png"
            gdal.GetDriverByName("PNG").CreateCopy(str(file), frame)
            file.with_suffix(".png.aux.xml").unlink(missing_ok=True)
            frames.append((file, gsd_m, (lat, lon, heading)))
    raise ValueError(f"{image} has no room for {count} frames: it is too small, or too little of it holds data")


def ground_size_m(source, to_geographic, to_utm, column, row):
    """Metres on the ground along one pixel, rounded to a millimetre."""
    points = []
    for step in (-10, 10):
        lon, lat, _ = to_geographic.TransformPoint(*gdal.ApplyGeoTransform(source.GetGeoTransform(), column + step, row))
        points.append(to_utm.TransformPoint(lon, lat))
    return round(math.dist(points[0][:2], points[1][:2]) / 20, 3)
