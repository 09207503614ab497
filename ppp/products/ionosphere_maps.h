// Interpolates maps of the ionosphere's electrons (IONEX).
#pragma once

#include <vector>

#include "ppp/products/ionosphere.h"
#include "ppp/readers/files/ionex.h"

namespace maploop::ppp {

class IonosphereMaps : public ElectronContent {
 public:
  // The files come in any order and must outlive this. Where two cover a moment, the one earlier in
  // the list counts.
  explicit IonosphereMaps(const std::vector<IonosphereMapFile>& files) : files_(&files) {}

  bool covers(GpsTime t) const override;
  // Interpolates between four nodes, and between two maps that turn with the sun, as the format's
  // description recommends. Returns nothing between two maps that are more than six hours apart,
  // and beside nodes without a value.
  std::optional<VerticalElectrons> at(const PiercePoint& place, GpsTime t) const override;

 private:
  const std::vector<IonosphereMapFile>* files_;
};

}  // namespace maploop::ppp
