// This file makes a calibration file as Velodyne ships it, with values like those of a real
// HDL-64E.
#pragma once

#include <filesystem>
#include <fstream>

namespace maploop::sensors {

inline void write_calibration(const std::filesystem::path& file, int lasers = 64) {
  std::ofstream out(file);
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\" ?>\n"
         "<!DOCTYPE boost_serialization>\n"
         "<boost_serialization signature=\"serialization::archive\" version=\"4\">\n"
         "<DB class_id=\"0\" tracking_level=\"1\" version=\"0\" object_id=\"_0\">\n"
         "<distLSB_>0.2</distLSB_>\n<points_>\n<count>64</count>\n"
         "<item_version>1</item_version>\n";
  for (int i = 0; i < lasers; ++i) {
    const double elevation = i < 32 ? 2.0 - i / 3.0 : -8.8 - (i - 32) / 2.0;
    out << "<item class_id=\"9\"><px class_id=\"10\"><id_>" << i << "</id_>"
        << "<rotCorrection_>" << (i % 4 - 1.5) * 2.3 << "</rotCorrection_>"
        << "<vertCorrection_>" << elevation << "</vertCorrection_>"
        << "<distCorrection_>" << 90 + i << "</distCorrection_>"
        << "<distCorrectionX_>" << 92 + i << "</distCorrectionX_>"
        << "<distCorrectionY_>" << 91 + i << "</distCorrectionY_>"
        << "<vertOffsetCorrection_>" << (i < 32 ? 21.5 : 12.0) << "</vertOffsetCorrection_>"
        << "<horizOffsetCorrection_>" << (i % 2 ? 2.6 : -2.6) << "</horizOffsetCorrection_>"
        << "<focalDistance_>0</focalDistance_><focalSlope_>0</focalSlope_></px></item>\n";
  }
  out << "</points_></DB></boost_serialization>\n";
}

}  // namespace maploop::sensors
