<?xml version="1.0"?>
<ogr:FeatureCollection xmlns:ogr="http://ogr.maptools.org/" xmlns:gml="http://www.opengis.net/gml">
<gml:featureMember><ogr:roads fid="roads.0"><ogr:geometryProperty><gml:LineString srsName="EPSG:4326"><gml:coordinates>38.27,37.75 38.271,37.751</gml:coordinates></gml:LineString></ogr:geometryProperty><ogr:highway>primary</ogr:highway></ogr:roads></gml:featureMember>
</ogr:FeatureCollection>
