// SPDX-License-Identifier: BSD-3-Clause
// Tables `topics` and `messages` of rosbag2's SQLite files, read in the order of recording.
#include "ros2_bag.h"

#include <sqlite3.h>

#include <algorithm>
#include <limits>
#include <map>

#include "roomgraph/core/errors.h"

namespace roomgraph::bags {
namespace {

// rosbag2 writes "sensor_msgs/msg/Image".
std::string ros1Name(std::string type) {
  if (const auto middle = type.find("/msg/"); middle != type.npos) type.replace(middle, 5, "/");
  return type;
}

// As a URI, in which some characters mean something.
std::string uriOf(const std::filesystem::path& file, const std::string& options) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string())
    uri += c == '%' ? "%25" : c == '?' ? "%3f" : c == '#' ? "%23" : std::string(1, c);
  return uri + "?" + options;
}

// One .db3 and its running query.
class BagDatabase {
 public:
  explicit BagDatabase(const std::filesystem::path& file) : file_(file) {
    open("mode=ro");
    // A recorder that was killed leaves a journal, which can be read only where its lock file may be made.
    if (sqlite3_exec(database_.get(), "SELECT 1 FROM sqlite_master", nullptr, nullptr, nullptr) ==
        SQLITE_CANTOPEN)
      open("immutable=1");
    const auto size =
        std::min<std::uintmax_t>(std::filesystem::file_size(file), std::numeric_limits<int>::max());
    sqlite3_limit(database_.get(), SQLITE_LIMIT_LENGTH, static_cast<int>(size));
  }

  void ask(const std::string& sql) {
    sqlite3_stmt* query = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &query, nullptr) != SQLITE_OK) fail();
    query_.reset(query);
  }
  /// SQLITE_ROW, SQLITE_DONE or an error.
  int step() { return sqlite3_step(query_.get()); }
  std::int64_t integer(int column) const { return sqlite3_column_int64(query_.get(), column); }
  std::string text(int column) const {
    const auto* begin = sqlite3_column_text(query_.get(), column);
    return begin ? reinterpret_cast<const char*>(begin) : "";
  }
  Bytes blob(int column) const {
    const auto* begin = static_cast<const std::uint8_t*>(sqlite3_column_blob(query_.get(), column));
    return {begin, begin ? static_cast<std::size_t>(sqlite3_column_bytes(query_.get(), column)) : 0};
  }
  std::string cause() const { return sqlite3_errmsg(database_.get()); }
  [[noreturn]] void fail() const {
    throw InputError(file_.string() + ": is no bag of ROS 2, or damaged: " + cause());
  }

 private:
  void open(const std::string& options) {
    sqlite3* database = nullptr;
    const int state = sqlite3_open_v2(uriOf(file_, options).c_str(), &database,
                                      SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    database_.reset(database);
    if (state != SQLITE_OK) fail();
  }

  std::filesystem::path file_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_{nullptr, sqlite3_close};
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> query_{nullptr, sqlite3_finalize};
};

class Ros2Bag : public BagReader {
 public:
  explicit Ros2Bag(std::vector<std::filesystem::path> files) : files_(std::move(files)) { openNext(); }

  bool next(RawMessage& message) override {
    while (database_) {
      const int state = database_->step();
      if (state == SQLITE_ROW) {
        ++rows_read_;
        if (take(message)) return true;
        continue;
      }
      if (state != SQLITE_DONE)
        problems_.push_back(files_[current_ - 1].string() + ": ends early: " + database_->cause() +
                            " behind message " + std::to_string(rows_read_));
      database_.reset();
      if (current_ < files_.size()) openNext();
    }
    return false;
  }
  const std::vector<BagTopic>& topics() const override { return topics_; }
  void wants(std::function<Want(const BagTopic&)> wants) override {
    wants_ = std::move(wants);
    for (std::size_t i = 0; i < topics_.size(); ++i) wanted_[i] = wants_(topics_[i]);
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
    database_ = std::make_unique<BagDatabase>(file);
    rows_read_ = last_row_ = 0;
    topic_of_.clear();
    database_->ask("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    int state = SQLITE_ROW;
    while ((state = database_->step()) == SQLITE_ROW) {
      const BagTopic topic{database_->text(1), ros1Name(database_->text(2))};
      if (const auto format = database_->text(3); format != "cdr") {
        problems_.push_back(file.string() + ": " + topic.name + " is left out: serialisation '" + format +
                            "'");
        continue;
      }
      topic_of_[database_->integer(0)] = add(topic);
    }
    if (state != SQLITE_DONE) database_->fail();
    database_->ask("SELECT max(id) FROM messages");
    rows_ = database_->step() == SQLITE_ROW ? database_->integer(0) : 0;
    query();
  }

  std::size_t add(const BagTopic& topic) {
    const auto known = std::find_if(topics_.begin(), topics_.end(), [&](const BagTopic& other) {
      return other.name == topic.name && other.type == topic.type;
    });
    const auto index = static_cast<std::size_t>(known - topics_.begin());
    if (known == topics_.end()) {
      topics_.push_back(topic);
      wanted_.push_back(wants_ ? wants_(topic) : Want::kAll);
    }
    return index;
  }

  // By id, which is the order of recording and that of the table: by time, a file without the index on time
  // would have to be sorted first.
  void query() {
    std::string whole = "-1", beginning = "-1";
    for (const auto& [id, topic] : topic_of_) {
      if (wanted_[topic] == Want::kAll) whole += "," + std::to_string(id);
      if (wanted_[topic] == Want::kBeginning) beginning += "," + std::to_string(id);
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
  std::unique_ptr<BagDatabase> database_;
  std::map<std::int64_t, std::size_t> topic_of_;
  std::int64_t rows_ = 0, last_row_ = 0, rows_read_ = 0;
  std::vector<BagTopic> topics_;
  std::vector<Want> wanted_;
  std::function<Want(const BagTopic&)> wants_;
  std::vector<std::string> problems_;
};

}  // namespace

std::unique_ptr<BagReader> openRos2Bag(const std::vector<std::filesystem::path>& files) {
  return std::make_unique<Ros2Bag>(files);
}

}  // namespace roomgraph::bags
