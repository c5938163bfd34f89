// SPDX-License-Identifier: BSD-3-Clause
// Tables `topics` and `messages` of rosbag2's SQLite files, read in the order of recording.
#include "ros2_bag.h"

#include <algorithm>
#include <map>

#include "roomgraph/datasets/sqlite_reader.h"
#include "topic_list.h"

namespace roomgraph::bags {
namespace {

class Ros2Bag : public BagReader {
 public:
  explicit Ros2Bag(std::vector<std::filesystem::path> files) : files_(std::move(files)) { openNext(); }

  bool next(RawMessage& message) override {
    while (database_) {
      const auto state = database_->step();
      if (state == SqliteReader::Step::kRow) {
        ++rows_read_;
        if (take(message)) return true;
        continue;
      }
      if (state == SqliteReader::Step::kFailed)
        problems_.push_back(files_[current_ - 1].string() + ": ends early: " + database_->cause() +
                            " behind message " + std::to_string(rows_read_));
      database_.reset();
      if (current_ < files_.size()) openNext();
    }
    return false;
  }
  const std::vector<BagTopic>& topics() const override { return topics_.topics(); }
  void wants(std::function<Want(const BagTopic&)> wants) override {
    topics_.setWants(std::move(wants));
    if (database_) query();
  }
  double progress() const override {
    const double within =
        rows_ > 0 ? std::min(1.0, static_cast<double>(last_row_) / static_cast<double>(rows_)) : 1;
    const double done = static_cast<double>(current_) - (database_ ? 1 : 0) + (database_ ? within : 0);
    return done / static_cast<double>(files_.size());
  }
  const std::vector<std::string>& problems() const override { return problems_; }

 private:
  void openNext() {
    const auto& file = files_[current_++];
    database_ = std::make_unique<SqliteReader>(file, "is no bag of ROS 2, or damaged");
    rows_read_ = last_row_ = 0;
    topic_of_.clear();
    database_->ask("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    auto state = SqliteReader::Step::kRow;
    while ((state = database_->step()) == SqliteReader::Step::kRow) {
      const BagTopic topic{database_->text(1), ros1Name(database_->text(2))};
      if (const auto format = database_->text(3); format != "cdr") {
        problems_.push_back(file.string() + ": " + topic.name + " is left out: serialisation '" + format +
                            "'");
        continue;
      }
      topic_of_[database_->integer(0)] = topics_.add(topic);
    }
    if (state == SqliteReader::Step::kFailed) database_->fail();
    database_->ask("SELECT max(id) FROM messages");
    rows_ = database_->step() == SqliteReader::Step::kRow ? database_->integer(0) : 0;
    query();
  }

  // By id, which is the order of recording and that of the table: by time, a file without the index on time
  // would have to be sorted first.
  void query() {
    std::string whole = "-1", beginning = "-1";
    for (const auto& [id, topic] : topic_of_) {
      if (topics_.wanted(topic) == Want::kAll) whole += "," + std::to_string(id);
      if (topics_.wanted(topic) == Want::kBeginning) beginning += "," + std::to_string(id);
    }
    database_->ask("SELECT id, topic_id, timestamp, CASE WHEN topic_id IN (" + whole +
                   ") THEN data ELSE substr(data, 1, " + std::to_string(kBeginningBytes) +
                   ") END FROM messages WHERE topic_id IN (" + whole + "," + beginning + ") ORDER BY id");
  }

  bool take(RawMessage& message) {
    last_row_ = database_->integer(0);
    const auto topic = topic_of_.find(database_->integer(1));
    if (topic == topic_of_.end()) return false;
    message.topic = topic->second;
    message.received_ns = database_->integer(2);
    message.cdr = true;
    message.bytes = database_->blob(3);
    return true;
  }

  std::vector<std::filesystem::path> files_;
  std::size_t current_ = 0;  ///< of the next file
  std::unique_ptr<SqliteReader> database_;
  std::map<std::int64_t, std::size_t> topic_of_;
  std::int64_t rows_ = 0, last_row_ = 0, rows_read_ = 0;
  TopicList topics_;
  std::vector<std::string> problems_;
};

}  // namespace

std::unique_ptr<BagReader> openRos2Bag(const std::vector<std::filesystem::path>& files) {
  return std::make_unique<Ros2Bag>(files);
}

}  // namespace roomgraph::bags
