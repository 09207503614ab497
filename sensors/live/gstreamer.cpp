#include "sensors/live/gstreamer.h"

#include <stdexcept>

#include "sensors/live/endpoint.h"

namespace maploop::sensors {

GstOwned<GstElement> parse_pipeline(const std::string& whole, const std::string& given) {
  static const bool ready = (gst_init(nullptr, nullptr), true);
  static_cast<void>(ready);
  GError* raw_error = nullptr;
  GstElement* pipeline =
      gst_parse_launch_full(whole.c_str(), nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &raw_error);
  const GstOwned<GError> error(raw_error);
  if (pipeline == nullptr) {
    throw std::invalid_argument(
        "'" + without_secrets(given) +
        "' is not a pipeline: " + (error ? without_secrets(error->message) : "it is empty") +
        "; test it with gst-launch-1.0; gst-inspect-1.0 lists the elements");
  }
  // The reference is floating: it has no owner until it is sunk.
  return GstOwned<GstElement>(GST_ELEMENT(gst_object_ref_sink(pipeline)));
}

std::string error_text(GstMessage* message) {
  GError* error = nullptr;
  gst_message_parse_error(message, &error, nullptr);
  const GstOwned<GError> owned(error);
  return without_secrets(error->message);
}

}  // namespace maploop::sensors
