// Where the sun stands: zenith and azimuth from date, time and place by ERFA (no refraction: the model's air has none).
#pragma once

#include <string>

namespace welkin {

struct SunAngles {
  double zenith_deg = 0.0;   // geometric (no refraction), of the disc's centre, topocentric
  double azimuth_deg = 0.0;  // clockwise from north
};

// utc: "YYYY-MM-DDThh:mm[:ss][Z]", "now", "today" (now) or "today hh:mm[:ss]" (UTC). Latitude north positive, longitude
// east positive, degrees. Valid 1900-2100; throws Error for text or values outside. Source: IAU 2006/2000A through
// ERFA.
SunAngles sun_angles(const std::string& utc, double latitude_deg, double longitude_deg);

}  // namespace welkin
