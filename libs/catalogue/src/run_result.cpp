// SPDX-License-Identifier: BSD-3-Clause
// RunResult to JSON and back; numbers of other reports.
#include "roomgraph/catalogue/run_result.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "roomgraph/core/json_integer.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "roomgraph run result";
constexpr int kResultVersion = 1;

Json inputJson(const RunInput& input) {
  return {{"name", input.name}, {"group", input.group},   {"seed", input.seed ? Json(*input.seed) : Json()},
          {"path", input.path}, {"sha256", input.sha256}, {"bytes", input.bytes}};
}

RunInput inputOf(const Json& json) {
  RunInput input{json.at("name"), json.at("group"), {}, json.at("path"), json.at("sha256"), json.at("bytes")};
  if (!json.at("seed").is_null()) input.seed = integerOf<std::int64_t>(json.at("seed"));
  return input;
}

Json resultJson(const RunResult& r) {
  Json json{{"format", kFormat},
            {"format_version", kResultVersion},
            {"name", r.name},
            {"variant", r.variant},
            {"status", r.status},
            {"reason", r.reason},
            {"input", inputJson(r.input)},
            {"key", r.key},
            {"evaluation_key", r.evaluation_key},
            {"version", r.version},
            {"revision", r.revision},
            {"program", r.program},
            {"command", r.command},
            {"exit_code", r.exit_code},
            {"started", r.started},
            {"wall_s", r.wall_s},
            {"cpu_s", r.cpu_s},
            {"peak_memory_mb", r.peak_memory_mb},
            {"keep", r.keep},
            {"figures", r.figures},
            {"timings", Json::object()},
            {"failures", Json::array()},
            {"files", r.files},
            {"parameters", r.parameters}};
  for (const auto& [stage, t] : r.timings)
    json["timings"][stage] = {{"calls", t.calls}, {"total_ms", t.total_ms}, {"max_ms", t.max_ms}};
  for (const auto& f : r.failures)
    json["failures"].push_back(
        {{"started", f.started}, {"exit_code", f.exit_code}, {"reason", f.reason}, {"wall_s", f.wall_s}});
  return json;
}

std::map<std::string, StageTotal> timingsOf(const Json& json) {
  std::map<std::string, StageTotal> out;
  for (const auto& [stage, t] : json.items())
    out[stage] = {integerOf<std::int64_t>(t.at("calls")), t.at("total_ms").get<double>(),
                  t.at("max_ms").get<double>()};
  return out;
}

RunResult resultOf(const Json& json) {
  if (json.at("format") != kFormat || json.at("format_version") != kResultVersion)
    throw std::invalid_argument("is no result of this version");
  RunResult r;
  const auto read = [&json](const char* key, auto& value) { json.at(key).get_to(value); };
  for (const auto& [key, value] :
       std::initializer_list<std::pair<const char*, std::string*>>{{"name", &r.name},
                                                                   {"variant", &r.variant},
                                                                   {"status", &r.status},
                                                                   {"reason", &r.reason},
                                                                   {"key", &r.key},
                                                                   {"evaluation_key", &r.evaluation_key},
                                                                   {"version", &r.version},
                                                                   {"revision", &r.revision},
                                                                   {"program", &r.program},
                                                                   {"started", &r.started},
                                                                   {"keep", &r.keep}})
    read(key, *value);
  r.input = inputOf(json.at("input"));
  read("command", r.command);
  read("exit_code", r.exit_code);
  read("wall_s", r.wall_s);
  read("cpu_s", r.cpu_s);
  read("peak_memory_mb", r.peak_memory_mb);
  read("figures", r.figures);
  read("files", r.files);
  read("parameters", r.parameters);
  r.timings = timingsOf(json.at("timings"));
  for (const auto& f : json.at("failures"))
    r.failures.push_back({f.at("started"), f.at("exit_code"), f.at("reason"), f.at("wall_s")});
  return r;
}

void addNumbers(const Json& json, const std::string& name, std::map<std::string, double>& out) {
  if (json.is_number() && std::isfinite(json.get<double>())) out[name] = json.get<double>();
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) addNumbers(value, name + "." + key, out);
}

// What nlohmann-json or the format object to, with the file's name.
template <class Read>
auto readJsonText(const std::string& text, const std::string& name, Read read) {
  const Json json = parseJson<Json>(text, name);
  try {
    return read(json);
  } catch (const std::exception& error) {
    throw InputError(name + ": " + firstLine(error));
  }
}

}  // namespace

std::string textOfRunResult(const RunResult& result) {
  return resultJson(result).dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunResult runResultOfText(const std::string& text, const std::string& name) {
  return readJsonText(text, name, resultOf);
}

RunResult readRunResult(const std::filesystem::path& file) {
  return runResultOfText(readTextFile(file), file.string());
}

void writeRunResult(const RunResult& result, const std::filesystem::path& file) {
  writeFileAtomically(file, textOfRunResult(result));
}

std::map<std::string, double> numbersOf(const std::filesystem::path& report, const std::string& prefix) {
  return readJsonText(readTextFile(report), report.string(), [&prefix](const Json& json) {
    std::map<std::string, double> out;
    addNumbers(json, prefix, out);
    return out;
  });
}

std::map<std::string, StageTotal> stageTotalsOf(const std::filesystem::path& summary) {
  return readJsonText(readTextFile(summary), summary.string(),
                      [](const Json& json) { return timingsOf(json.at("timings")); });
}

}  // namespace roomgraph
