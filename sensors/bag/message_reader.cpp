#include "sensors/bag/message_reader.h"

#include <algorithm>
#include <map>
#include <new>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "msgs/input_file.h"
#include "sensors/bag/bag_files.h"

namespace maploop::sensors {
namespace {

constexpr const char* too_large = "does not fit into memory";

// Reads the files of a recording one after the other; only one of them is open.
class FilesReader final : public MessageReader {
 public:
  FilesReader(std::vector<std::filesystem::path> files, MessageSelection selection)
      : files_(std::move(files)), selection_(std::move(selection)) {
    while (open_next()) {
      if (reader_) return;
      damages_.push_back(damage_);
    }
    throw FileError(damages_.front().file, damages_.front().reason);
  }

  Item next() override {
    if (next_damage_ < damages_.size()) {
      damage_ = damages_[next_damage_++];
      return Item::damage;
    }
    for (;;) {
      const Item item = reader_ ? reader_->next() : Item::end;
      if (item == Item::message) message_ = reader_->message();
      if (item == Item::damage) damage_ = reader_->damage();
      if (item != Item::end) return item;
      if (!open_next()) return Item::end;
      if (!reader_) return Item::damage;
    }
  }

 private:
  // Leaves no reader, but damage_, if the file cannot be opened. Returns false behind the last.
  bool open_next() {
    reader_.reset();
    if (next_file_ == files_.size()) return false;
    const std::filesystem::path& file = files_[next_file_++];
    try {
      reader_ = bag::open_file(file, topics_, selection_);
    } catch (const FileError& error) {
      damage_ = {file, 0, error.reason()};
    } catch (const std::runtime_error& error) {
      damage_ = {file, 0, error.what()};
    } catch (const std::bad_alloc&) {
      damage_ = {file, 0, too_large};
    }
    return true;
  }

  std::vector<std::filesystem::path> files_;
  MessageSelection selection_;
  std::shared_ptr<bag::TopicTable> topics_ = std::make_shared<bag::TopicTable>();
  std::unique_ptr<bag::RecordingReader> reader_;
  std::size_t next_file_ = 0;
  std::vector<BagDamage> damages_;  // before the first file that could be opened
  std::size_t next_damage_ = 0;
};

class Summary {
 public:
  void add(const TopicSummary& part) {
    if (part.messages == 0) return;
    const Topic& topic = part.topic;
    const auto [place, is_new] = topics_.try_emplace({topic.name, topic.type, topic.encoding},
                                                     TopicSummary{topic, 0, {}, {}});
    TopicSummary& sum = place->second;
    sum.first = sum.messages == 0 ? part.first : std::min(sum.first, part.first);
    sum.last = std::max(sum.last, part.last);
    sum.messages += part.messages;
  }
  void add(const BagDamage& damage) {
    constexpr std::size_t most = 100;
    if (damage_.size() < most) damage_.push_back(damage);
  }
  // Without an index all messages are read, and the damage on the way is found.
  void add(bag::RecordingReader& reader) {
    const auto index = reader.index_summary();
    if (index)
      for (const TopicSummary& topic : *index) add(topic);
    while (!index || reader.has_damage()) {
      const auto item = reader.next();
      if (item == MessageReader::Item::end) return;
      if (item == MessageReader::Item::damage) {
        add(reader.damage());
      } else {
        const RecordedMessage& message = reader.message();
        add(TopicSummary{*message.topic, 1, message.received, message.received});
      }
    }
  }
  BagSummary result() {
    BagSummary summary{{}, std::move(damage_)};
    for (auto& [name, topic] : topics_) summary.topics.push_back(std::move(topic));
    return summary;
  }

 private:
  std::map<std::tuple<std::string, std::string, std::string>, TopicSummary> topics_;
  std::vector<BagDamage> damage_;
};

}  // namespace

bool is_bag(const std::filesystem::path& path) {
  try {
    const auto files = bag::recording_files(path);
    return std::any_of(files.begin(), files.end(), bag::is_recording_file);
  } catch (const std::runtime_error&) {
    return false;
  }
}

std::unique_ptr<MessageReader> open_messages(const std::filesystem::path& path,
                                             const MessageSelection& selection) {
  return std::make_unique<FilesReader>(bag::recording_files(path), selection);
}

BagSummary summarize(const std::filesystem::path& path) {
  const auto files = bag::recording_files(path);
  const auto topics = std::make_shared<bag::TopicTable>();
  Summary summary;
  std::optional<FileError> failure;
  std::size_t opened = 0;
  const auto note = [&](const std::filesystem::path& file, const std::string& reason) {
    summary.add(BagDamage{file, 0, reason});
    if (!failure) failure.emplace(file, reason);
  };
  for (const auto& file : files) {
    try {
      summary.add(*bag::open_file(file, topics, {}));
      ++opened;
    } catch (const FileError& error) {
      note(file, error.reason());
    } catch (const std::runtime_error& error) {
      note(file, error.what());
    } catch (const std::bad_alloc&) {
      note(file, too_large);
    }
  }
  if (opened == 0) throw FileError(*failure);
  return summary.result();
}

}  // namespace maploop::sensors
