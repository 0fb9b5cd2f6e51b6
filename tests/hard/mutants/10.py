"""Mutants of chapter 10, sky view table: name, file under shaders/, text, what it becomes, test that must fail."""
PLACE = "10 map: a direction's place is what trigonometry in double says"
BACK = "10 map: texel to direction and back is the texel's centre"
MUTANTS = [
    ("the azimuth's sine instead of its half's", "10_sky_view_lut/sky_view_map.glsl",
     "coordinates.azimuth_coordinate = min(0.5 * sqrt(x * x + y * y), 1.0);", "coordinates.azimuth_coordinate = min(sqrt(x * x + y * y), 1.0);", PLACE),
    ("the horizon's dip without h^2", "03_planet_and_rays/ray_sphere.glsl",
     "sqrt(h * (2.0 * ground_radius_km + h)) / r", "sqrt(h * 2.0 * ground_radius_km) / r", PLACE),
    ("the angle from the horizon with a wrong sign", "10_sky_view_lut/sky_view_map.glsl",
     "float s = horizon.y * view.z - horizon.x * sine;", "float s = horizon.y * view.z + horizon.x * sine;", PLACE),
    ("rows without their root", "10_sky_view_lut/sky_view_map.glsl",
     "coordinates.elevation_coordinate = sqrt(coordinates.below_horizon ? n * (1.0 + knee) / (n + knee) : n);",
     "coordinates.elevation_coordinate = coordinates.below_horizon ? n * (1.0 + knee) / (n + knee) : n;", BACK),
    ("rows below the horizon as above it", "10_sky_view_lut/sky_view_map.glsl",
     "  return m + sqrt(m);", "  return 1.0e6;", "10 hard: just under the horizon*"),
    ("columns of a texel map that is not the inverse", "10_sky_view_lut/sky_view_map.glsl",
     "coordinates.azimuth_coordinate = float(texel.x) / float(size.x - 1);", "coordinates.azimuth_coordinate = float(texel.x) / float(size.x);", BACK),
    ("ground rows that begin among the sky's", "10_sky_view_lut/sky_view_map.glsl",
     "half_rows + coordinates.elevation_coordinate * (half_rows - 1.0)", "half_rows - 1.0 + coordinates.elevation_coordinate * half_rows", BACK),
    ("the table filled with the sun behind", "10_sky_view_lut/fill_sky_view.glsl",
     "const vec3 sun = vec3(viewpoint.z, 0.0, viewpoint.y);", "const vec3 sun = vec3(-viewpoint.z, 0.0, viewpoint.y);", "10 hard: the horizon is a line*"),
    ("a night stored magnified and read as it is", "10_sky_view_lut/sky_view.glsl",
     ".rgb * SKY_VIEW_UNIT;", ".rgb;", "10 hard: a night keeps its digits in 16 bits"),
]
