// This file owns GStreamer's objects. Only .cpp files include it.
#pragma once

#include <gst/gst.h>

#include <memory>
#include <string>

#include "msgs/image.h"

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

// Initializes GStreamer and parses the pipeline `whole`. Throws std::invalid_argument with
// GStreamer's message and `given`, the part of the text that the user wrote.
GstOwned<GstElement> parse_pipeline(const std::string& whole, const std::string& given);

// Returns the text of an error message, without secrets.
std::string error_text(GstMessage* message);

// Copies the grey image of a sample; leaves `image` empty if there is none.
void copy_grey(GstSample* sample, GreyImage& image);

}  // namespace maploop::sensors
