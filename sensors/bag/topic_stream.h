// This file reads the messages of some topics of a bag, and judges the samples that are made of
// them.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "msgs/input_limits.h"
#include "msgs/sample.h"
#include "sensors/bag/bag_sources.h"
#include "sensors/bag/message_reader.h"
#include "sensors/bag/ros_messages.h"
#include "sensors/source.h"

namespace maploop::sensors {

class TopicStream {
 public:
  TopicStream(SharedBagSettings settings, std::set<std::string> topics)
      : settings_(std::move(settings)),
        reader_(open_messages(settings_->path, {std::move(topics), Time::min()})) {}

  // Returns the next message, or nullptr at the end; damage is reported.
  const RecordedMessage* next(SourceReport& report) {
    while (true) {
      switch (reader_->next()) {
        case MessageReader::Item::message:
          ++number_;
          return &reader_->message();
        case MessageReader::Item::damage:
          report.refuse({reader_->damage().file.string(), 0,
                         "damage at byte " + std::to_string(reader_->damage().offset) + ": " +
                             reader_->damage().reason});
          break;
        case MessageReader::Item::end:
          return nullptr;
      }
    }
  }

  // Decodes a message; returns whether that was possible.
  template <class T>
  bool decoded(const RecordedMessage& message, T& to, SourceReport& report) {
    try {
      decode(*message.topic, message.data, to);
      return true;
    } catch (const std::invalid_argument& e) {
      refuse(*message.topic, e.what(), report);
      return false;
    }
  }

  Time stamp(const RosHeader& header, const RecordedMessage& message) const {
    return settings_->header_stamps ? header.stamp : message.received;
  }

  // Returns whether a sample follows the previous one; refuses it otherwise.
  bool follows(const Topic& topic, const Sample& sample, SourceReport& report) {
    using input_limits::within;
    std::string why;
    if (last_ && (sample.stamp <= last_->first || sample.available <= last_->second)) {
      why = "its stamp is not later than that of the one before it";
    } else if (last_ && !within(input_limits::longest_pause, last_->second, sample.available)) {
      why = "it is more than a day later than the one before it";
    } else {
      last_ = {sample.stamp, sample.available};
      return true;
    }
    refuse(topic, why, report);
    return false;
  }

  void refuse(const Topic& topic, const std::string& why, SourceReport& report) const {
    report.refuse({settings_->path.string(), 0,
                   topic.name + ", message " + std::to_string(number_) + ": " + why});
  }

  const BagSettings& settings() const { return *settings_; }
  std::uint64_t number() const { return number_; }  // of the messages read

 private:
  SharedBagSettings settings_;
  std::unique_ptr<MessageReader> reader_;
  std::uint64_t number_ = 0;
  std::optional<std::pair<Time, Time>> last_;  // stamp, available
};

// Makes the samples of a source by an object with next(sample, report).
template <class T, class Maker>
std::unique_ptr<Source<T>> made_by(Maker maker) {
  return made<T>([maker = std::move(maker)](T& sample, SourceReport& report) mutable {
    return maker.next(sample, report);
  });
}

}  // namespace maploop::sensors
