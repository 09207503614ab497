// GStreamer's objects, owned. For the .cpp files of this folder alone.
#pragma once

#include <gst/gst.h>

#include <memory>
#include <string>

namespace maploop::sensors {

struct GstUnref {
  void operator()(GstElement* e) const { gst_object_unref(e); }
  void operator()(GstBus* b) const { gst_object_unref(b); }
  void operator()(GstClock* c) const { gst_object_unref(c); }
  void operator()(GstMessage* m) const { gst_message_unref(m); }
  void operator()(GstSample* s) const { gst_sample_unref(s); }
  void operator()(GError* e) const { g_error_free(e); }
};
template <class T>
using GstOwned = std::unique_ptr<T, GstUnref>;

// Initializes GStreamer. Throws std::invalid_argument: what it says of `given`, the part of the
// whole text that the user wrote.
GstOwned<GstElement> parse_pipeline(const std::string& whole, const std::string& given);

// What an error message says.
std::string error_text(GstMessage* message);

}  // namespace maploop::sensors
