// OpenCV asks these for a picture that is in a graphics card. A vehicle has none: they say so, in
// place of GLX and the seven libraries of X11 behind it.
extern "C" {
// NOLINTBEGIN(readability-identifier-naming): GLX has these names

void* glXGetCurrentContext() {
  return nullptr;
}

void* glXGetCurrentDisplay() {
  return nullptr;
}

void* glXGetProcAddressARB(const unsigned char*) {
  return nullptr;
}

// NOLINTEND(readability-identifier-naming)
}
