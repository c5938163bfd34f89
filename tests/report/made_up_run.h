// SPDX-License-Identifier: BSD-3-Clause
// Files of a made-up run of any length, and the data in a page read back.
#pragma once

#include <cmath>
#include <fstream>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "roomgraph/report/report.h"
#include "temporary_folder.h"

namespace roomgraph::test {

using nlohmann::json;

constexpr double kStart = 1700000000;

struct MadeUpSize {
  double seconds = 20, rate_hz = 10;
  int objects = 3, boxes_per_frame = 2;
};

/// The robot drives circles of 2 m radius around (0, 2), 0.25 m/s; its live pose is off by a growing
/// distance.
inline std::array<double, 3> poseAtTime(double s) {
  const double angle = s / 8;
  return {2 * std::sin(angle), 2 - 2 * std::cos(angle), angle};
}

inline void writePoses(const TemporaryFolder& folder, const std::string& name, const MadeUpSize& size,
                       double off_m) {
  std::ofstream out(folder.file(name));
  out << std::fixed << std::setprecision(7);
  for (int i = 0; i < size.seconds * size.rate_hz; ++i) {
    const double s = i / size.rate_hz;
    const auto [x, y, yaw] = poseAtTime(s);
    out << kStart + s << ' ' << x + off_m * s << ' ' << y << " 0 0 0 " << std::sin(yaw / 2) << ' '
        << std::cos(yaw / 2) << '\n';
  }
}

inline json madeUpObject(int id) {
  const double x = 3 + id, y = 0.5 * id;
  return {{"id", id},
          {"class", id % 2 ? "sofa" : "swivel_chair"},
          {"model", "made_up"},
          {"shape", id % 2 ? "cuboid" : "cylinder"},
          {"x", x},
          {"y", y},
          {"z", 0.01},
          {"yaw", 0.3},
          {"has_yaw", id % 2 == 1},
          {"size_wdh", {1.5, 0.8, 0.9}},
          {"footprint", {{x - .7, y - .4}, {x + .7, y - .4}, {x + .7, y + .4}, {x - .7, y + .4}}},
          {"covariance", {{.04, .01, 0, 0}, {.01, .02, 0, 0}, {0, 0, .0001, 0}, {0, 0, 0, .0009}}},
          {"existence", 0.9 - 0.01 * id},
          {"class_posterior", {{"sofa", 0.75}, {"swivel_chair", 0.25}}},
          {"observations", 40 + id},
          {"evidence", {{"filter", 3.5}, {"crossed", 0.125}}}};
}

inline void writeObjects(const TemporaryFolder& folder, const std::string& name, int first, int count) {
  json content{{"recording", "made_up.rawlog"}, {"version", "1"}, {"landmarks", json::array()}};
  for (int id = first; id < first + count; ++id) content["landmarks"].push_back(madeUpObject(id));
  folder.write(name, content.dump());
}

/// Frame i sees the objects i, i + 1, …; each is chosen with 0.95, but with 0.6 in every fifth frame.
inline void writeAssociations(const TemporaryFolder& folder, const MadeUpSize& size) {
  std::ofstream out(folder.file("associations.jsonl"));
  for (int i = 0; i < size.seconds * size.rate_hz; ++i) {
    json frame{{"timestamp", kStart + i / size.rate_hz}, {"measurements", json::array()}};
    for (int k = 0; k < size.boxes_per_frame; ++k) {
      const int id = (i + k) % size.objects, other = (id + 1) % size.objects;
      const bool is_new = i < size.objects && k == 0;
      const double p = i % 5 == 0 ? 0.6 : 0.95;
      const json chosen = is_new ? json("new") : json(id);
      frame["measurements"].push_back(
          {{"class", "sofa"},
           {"bbox", {1.25, 2.5, 100.125, 200.75}},
           {"landmark", id},
           {"new", is_new},
           {"track", k},
           {"beta", 1},
           {"confidence", 0.8},
           {"posterior", {{{"landmark", chosen}, {"p", p}}, {{"landmark", other}, {"p", 1 - p}}}}});
    }
    out << frame.dump() << '\n';
  }
}

inline void writeTimingsAndSummary(const TemporaryFolder& folder, const MadeUpSize& size) {
  const int calls = static_cast<int>(size.seconds * size.rate_hz);
  std::ofstream out(folder.file("timings.csv"));
  out << "timestamp,stage,ms,cpu_ms,memory_mb\n" << std::fixed << std::setprecision(3);
  for (int i = 0; i < calls; ++i)
    for (const char* stage : {"matching", "selection, late"})
      out << kStart + i / size.rate_hz << ',' << stage << ",2.500,5.000," << 100 + i << '\n';
  const json spent{{"calls", calls}, {"mean_ms", 2.5}, {"max_ms", 2.5}, {"total_ms", 2.5 * calls}};
  folder.write(
      "summary.json",
      json{{"input", "/data/made_up.rawlog"},
           {"version", "1.2"},
           {"revision", "abc"},
           {"command", {"roomgraph", "run", "x y"}},
           {"interrupted", "no"},
           {"counts", {{"frames", calls}, {"frames_lost", 7}, {"scans", 9}, {"loop_closures", 2}}},
           {"reasons", {{"too dark", 7}}},
           {"records_used", {{"Images", calls}}},
           {"records_skipped", {{"broken", 3}}},
           {"input_warning", "cut off"},
           {"sensor_warnings", {"two lidars"}},
           {"findings",
            {{{"severity", "warning"}, {"place", "LIDAR"}, {"what", "gap of 2 s"}, {"hint", "drive on"}},
             {{"severity", "note"}, {"place", "KINECT"}, {"what", "dark <b>"}, {"hint", ""}}}},
           {"timings", {{"matching", spent}, {"selection, late", spent}}},
           {"peak_memory_mb", 123.44},
           {"wall_s", 12.34}}
          .dump());
}

/// 4 x 3 cells of 0.5 m from (-1, -2): the first row is occupied, the second free, the last unknown.
inline void writeGrid(const TemporaryFolder& folder) {
  folder.write("map.yaml",
               "image: map.pgm\nresolution: 0.5\norigin: [-1, -2, 0]\nnegate: 0\n"
               "occupied_thresh: 0.65\nfree_thresh: 0.196\nmode: trinary\n");
  const std::string row(4, '\xfe');
  folder.write("map.pgm", "P5\n4 3\n255\n" + std::string(4, '\0') + row + std::string(4, '\xcd'));
}

/// Poses 0 to 3 with times 0, 5, 10, 15 s; a loop from 0 to 3; a local map 10000000 tied to pose 1.
inline void writeGraph(const TemporaryFolder& folder) {
  std::ostringstream out;
  for (int i = 0; i < 4; ++i)
    out << "VERTEX_SE3:QUAT " << i << ' ' << i << ' ' << 2 * i << " 0 0 0 0 1\n# STAMP " << i << ' '
        << std::fixed << kStart + 5 * i << std::defaultfloat << '\n';
  out << "# CLOSURE 3 0 lidar\nVERTEX_SE3:QUAT 10000000 9 9 0 0 0 0 1\nFIX 0\n";
  for (const char* edge : {"0 1", "1 2", "2 3", "10000000 1", "3 0"})
    out << "EDGE_SE3:QUAT " << edge << " 1 0 0 0 0 0 1\n";
  folder.write("graph.g2o", out.str());
}

inline void writeRun(const TemporaryFolder& folder, const MadeUpSize& size = {}) {
  writePoses(folder, "trajectory.tum", size, 0);
  writePoses(folder, "live.tum", size, 0.001);
  writeObjects(folder, "landmarks.json", 0, size.objects);
  writeObjects(folder, "candidates.json", 0, size.objects + 2);
  writeAssociations(folder, size);
  writeTimingsAndSummary(folder, size);
  writeGrid(folder);
  writeGraph(folder);
  folder.write(
      "lost.jsonl",
      json{{"sensor", "camera"},
           {"from", kStart + 4},
           {"to", kStart + 6.5},
           {"records", 25},
           {"why", "too dark"}}
              .dump() +
          "\n" +
          json{
              {"sensor", "lidar"}, {"from", kStart}, {"to", kStart + 2}, {"records", 0}, {"why", "no record"}}
              .dump() +
          "\n");
  folder.write("config.ini", "[a]\nx = 5e-04\ny = 2\n[b]\nname =\n");
  folder.write("objects.ini", "[sofa]\ncolor = #3f7fd0\n[swivel_chair]\ncolor = red\n");
}

/// What stands in the page's data element, between the tags that a browser would find.
inline std::string dataText(const std::string& html) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const auto begin = html.find(open) + open.size();
  return html.substr(begin, html.find("</script", begin) - begin);
}

inline json dataOf(const ReportPage& page) {
  return json::parse(dataText(page.html));
}

inline ReportPage reportOf(const TemporaryFolder& folder, const std::filesystem::path& truth = {}) {
  return makeReport(
      {{{folder.path(), "made up"}}, truth, {{"a.x", {"0.0005"}}, {"a.y", {"1", "3"}}, {"b.name", {""}}}});
}

inline json runOf(const TemporaryFolder& folder) {
  return dataOf(reportOf(folder)).at("runs").at(0);
}

}  // namespace roomgraph::test
