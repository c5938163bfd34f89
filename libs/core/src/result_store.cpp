// SPDX-License-Identifier: BSD-3-Clause
// Results as journal records: name, time, bytes.
#include "roomgraph/core/result_store.h"

#include <cstring>
#include <stdexcept>

namespace roomgraph {
namespace {

std::string labelOf(std::string_view name, double t) {
  std::string label(name);
  label.push_back('\0');
  label.append(reinterpret_cast<const char*>(&t), sizeof t);
  return label;
}

JournalledResults::Found lookInto(const std::filesystem::path& file, std::string_view key) {
  Journal journal(file, key);
  JournalledResults::Found found;
  while (journal.next()) ++found.results;
  found.bytes = journal.bytes();
  found.damaged = journal.damagedBytes();
  return found;
}

}  // namespace

std::string bytesOfNumbers(const std::vector<double>& numbers) {
  return std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
}

std::vector<double> numbersFrom(const std::string& bytes) {
  if (bytes.size() % sizeof(double) != 0) throw std::invalid_argument("not a whole number of numbers");
  std::vector<double> numbers(bytes.size() / sizeof(double));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

JournalledResults::JournalledResults(const std::filesystem::path& file, std::string_view key, double sync_s)
    : found_(lookInto(file, key)), journal_(file, key), sync_s_(sync_s) {}

std::optional<std::string> JournalledResults::recall(std::string_view name, double t) {
  if (stopped_ || !recalling_) return std::nullopt;
  const std::string label = labelOf(name, t);
  auto record = journal_.next();
  if (record && record->starts_with(label)) return record->substr(label.size());
  recalling_ = false;
  diverged_ = record.has_value();
  if (diverged_) journal_.unread();
  return std::nullopt;
}

void JournalledResults::keep(std::string_view name, double t, std::string_view bytes) {
  if (stopped_ || sync_s_ <= 0) return;
  journal_.append(labelOf(name, t).append(bytes));
  ++kept_;
  const auto now = std::chrono::steady_clock::now();
  if (std::chrono::duration<double>(now - synced_).count() < sync_s_) return;
  journal_.sync();
  synced_ = std::chrono::steady_clock::now();
}

}  // namespace roomgraph
