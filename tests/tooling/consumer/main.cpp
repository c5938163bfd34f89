// SPDX-License-Identifier: BSD-3-Clause
// A program outside the project that runs the whole pipeline on a recording: consumer CONFIG OBJECTS RAWLOG.
#include <iostream>
#include <memory>

#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/pipeline/read_options.h"
#include "roomgraph/pipeline/replay.h"

struct FrameCounter : roomgraph::Sink {
  int frames = 0;
  void onStep(const roomgraph::StepReport& step) override { frames += step.kind == roomgraph::StepReport::Kind::kFrame; }
};

int main(int, char** argv) {
  auto setup = roomgraph::makeSetup(roomgraph::Config::fromFile(argv[1]), argv[2]);
  roomgraph::RawlogReader recording(argv[3], roomgraph::readOptionsOf(setup->options));
  roomgraph::SemanticSlam slam(std::move(setup));
  const auto counter = std::make_shared<FrameCounter>();
  slam.addSink(counter);
  roomgraph::replay(recording, slam);
  for (const auto& landmark : slam.finish().map.landmarks)
    std::cout << landmark.class_name << " at " << landmark.position.head<2>().transpose() << "\n";
  std::cout << counter->frames << " frames\n";
}
