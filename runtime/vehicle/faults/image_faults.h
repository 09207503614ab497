// Faults of a camera: what they do to a pair of images.
#pragma once

#include <cstdint>

#include "msgs/image.h"
#include "runtime/vehicle/faults/strike.h"

namespace maploop::vehicle {

void blacken(StereoPair& pair);

// Replaces both images by noise that depends only on the seed and the stamp; the two differ.
void scramble(StereoPair& pair, std::uint64_t seed);

// Makes each pixel the mean of the square of 2 `radius` + 1 pixels around it, as far as there are
// some.
void blur(StereoPair& pair, int radius);

// Takes the share `lost` of the light away, and the grey levels with it.
void dim(StereoPair& pair, double lost);

// Shows what both cameras see after they have been turned to the left by `angle` (rad), each about
// its own centre. `focal_length` in px; what was not in the image before is black.
void turn(StereoPair& pair, double angle, double focal_length);

// Applies a fault that changes images; other kinds leave them as they are.
void distort(StereoPair& pair, const Strike& strike);

}  // namespace maploop::vehicle
