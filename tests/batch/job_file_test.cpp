// SPDX-License-Identifier: BSD-3-Clause
// Job files: what they say, and messages about what is wrong in them.
#include "roomgraph/batch/job_file.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class JobFiles : public ::testing::Test {
 protected:
  JobFile read(const std::string& text) const { return readJobFile(folder.write("jobs.yaml", text)); }
  std::string problem(const std::string& text) const {
    return messageOf<ConfigError>([&] { read(text); });
  }
  const TemporaryFolder folder;
};

TEST_F(JobFiles, SayWhatIsToRun) {
  folder.write("room.json", "{}");
  std::filesystem::create_directory(folder.file("lab"));
  folder.write("fast.ini", "");
  const JobFile jobs = read(
      "inputs:\n"
      "  - lab/*.rawlog\n"
      "  - {files: [a.rawlog, /data/b.rawlog], truth: {trajectory: \"{folder}/{name}.tum\", objects: "
      "things.json}, group: real}\n"
      "  - {files: c.rawlog, truth: none}\n"
      "  - simulate: {world: room.json, seeds: 1-3}\n"
      "  - simulate: {flats: [7, 20-21], rooms: 2, handheld: true, meshes: lab}\n"
      "variants:\n"
      "  - name: default\n"
      "  - {name: fast, config: fast.ini, set: [lidar.enabled=false, a.b=1], pose: \"K=0,0,1,0,0,0\"}\n"
      "limits: {jobs: 3, threads: 2, memory: 8 GB, time: 30 min, retries: 1}\n"
      "split: 10 min\noverlap: 30 s\n"
      "slurm: {partition: long, time: 4 h, memory: 8 GB, cpus: 2, options: [--account=lab, --nice], setup: "
      "module "
      "load x, poll: 5 s, patience: 2 min}\n"
      "keep: map\n"
      "evaluation: {trajectory: --interpolate --max-difference 0.1, map: none}\n");
  EXPECT_EQ(jobs.split.length_s, 600);
  EXPECT_EQ(jobs.split.overlap_s, 30);
  EXPECT_EQ(jobs.slurm.partition, "long");
  EXPECT_EQ(jobs.slurm.time_s, 4 * 3600);
  EXPECT_EQ(jobs.slurm.memory_mb, 8000);
  EXPECT_EQ(jobs.slurm.cpus, 2);
  EXPECT_THAT(jobs.slurm.options, ElementsAre("--account=lab", "--nice"));
  EXPECT_THAT(jobs.slurm.setup, ElementsAre("module load x"));
  EXPECT_EQ(jobs.slurm.poll_s, 5);
  EXPECT_EQ(jobs.slurm.patience_s, 120);
  ASSERT_EQ(jobs.inputs.size(), 5u);
  EXPECT_THAT(jobs.inputs[0].patterns, ElementsAre(folder.file("lab/*.rawlog").string()));
  EXPECT_TRUE(jobs.inputs[0].search_truth);
  EXPECT_THAT(jobs.inputs[1].patterns, ElementsAre(folder.file("a.rawlog").string(), "/data/b.rawlog"));
  EXPECT_EQ(jobs.inputs[1].truth.at("trajectory"), "{folder}/{name}.tum");
  EXPECT_EQ(jobs.inputs[1].truth.at("objects"), folder.file("things.json").string());
  EXPECT_EQ(jobs.inputs[1].group, "real");
  EXPECT_FALSE(jobs.inputs[2].search_truth);
  EXPECT_TRUE(jobs.inputs[2].truth.empty());
  EXPECT_THAT(jobs.inputs[3].simulated->seeds, ElementsAre(1, 2, 3));
  EXPECT_EQ(jobs.inputs[3].simulated->world, folder.file("room.json"));
  EXPECT_THAT(jobs.inputs[4].simulated->seeds, ElementsAre(7, 20, 21));
  EXPECT_TRUE(jobs.inputs[4].simulated->handheld);
  EXPECT_EQ(jobs.inputs[4].simulated->meshes, folder.file("lab"));
  ASSERT_EQ(jobs.variants.size(), 2u);
  EXPECT_EQ(jobs.variants[1].config, folder.file("fast.ini"));
  EXPECT_THAT(jobs.variants[1].overrides, ElementsAre("lidar.enabled=false", "a.b=1"));
  EXPECT_THAT(jobs.variants[1].poses, ElementsAre("K=0,0,1,0,0,0"));
  EXPECT_EQ(jobs.limits.jobs, 3);
  EXPECT_EQ(jobs.limits.threads, 2);
  EXPECT_EQ(jobs.limits.memory_mb, 8000);
  EXPECT_EQ(jobs.limits.time_s, 1800);
  EXPECT_EQ(jobs.limits.retries, 1);
  EXPECT_EQ(jobs.keep, Keep::kMap);
  EXPECT_THAT(jobs.evaluation.at("trajectory"), ElementsAre("--interpolate", "--max-difference", "0.1"));
  EXPECT_THAT(jobs.evaluation.at("map"), ElementsAre("none"));
}

TEST_F(JobFiles, NameFileLineKeyAndCause) {
  EXPECT_THAT(problem("inputs:\n  - a.rawlog\nvariant: x\n"),
              AllOf(HasSubstr("jobs.yaml:3: unknown key 'variant' (did you mean 'variants'?)"),
                    HasSubstr("known: inputs")));
  EXPECT_THAT(problem("inputs:\n  - simulate:\n      sead: 3\n"),
              HasSubstr("jobs.yaml:3: inputs[1].simulate: unknown key 'sead'"));
  EXPECT_THAT(problem("inputs: [a]\nlimits:\n  jobs: 2\n  time: soon\n"),
              HasSubstr("jobs.yaml:4: limits.time: 'soon' is none; write it like 30 min"));
  EXPECT_THAT(problem("inputs: [a]\nlimits: {jobs: -1}\n"),
              HasSubstr("jobs.yaml:2: limits.jobs: is to be a whole number"));
  EXPECT_THAT(problem("inputs: [a]\nlimits: {jobs: 1, jobs: 2}\n"),
              HasSubstr("key 'jobs' stands here twice"));
  EXPECT_THAT(
      problem("inputs: [a]\nslurm:\n  options: [account=lab]\n"),
      HasSubstr("jobs.yaml:3: slurm.options: 'account=lab' is no option; write it like --account=lab"));
  EXPECT_THAT(problem("inputs: [a]\nslurm: {partitoin: x}\n"), HasSubstr("slurm: unknown key 'partitoin'"));
  EXPECT_THAT(problem("inputs: [a\n"), HasSubstr("not valid YAML"));
  EXPECT_THAT(problem("inputs: [a]\nkeep: most\n"),
              HasSubstr("jobs.yaml:2: keep: keep: 'most' is none of summary, map, all"));
  EXPECT_THAT(problem("variants: [{name: a}]\n"), HasSubstr("has no inputs"));
  EXPECT_THAT(problem("inputs: [a]\nvariants:\n  - name: a\n  - name: a\n"),
              HasSubstr("jobs.yaml:4: variants[2]: there are two variants 'a'"));
  EXPECT_THAT(problem("inputs: [a]\nvariants: [{name: ../x}]\n"), HasSubstr("needs a name of letters"));
  EXPECT_THAT(problem("inputs: [a]\nvariants: [{name: x, config: no.ini}]\n"),
              HasSubstr("no.ini: no such file"));
  EXPECT_THAT(problem("inputs:\n  - simulate: {world: no.json}\n"), HasSubstr("no.json: no such file"));
  EXPECT_THAT(problem("inputs:\n  - simulate: {seeds: 1-2}\n"),
              HasSubstr("either a world with seeds, or flats"));
  EXPECT_THAT(problem("inputs:\n  - {files: a, simulate: {flats: 1}}\n"),
              HasSubstr("either files or simulate"));
  EXPECT_THAT(problem("just text\n"), HasSubstr("is to be a map"));
  EXPECT_THAT(messageOf<InputError>([&] { readJobFile(folder.file("none.yaml")); }), HasSubstr("none.yaml"));
}

TEST(Quantities, AreWrittenAsPeopleDo) {
  EXPECT_EQ(megabytesOf("500"), 500);
  EXPECT_EQ(megabytesOf("1.5 GB"), 1500);
  EXPECT_NEAR(megabytesOf("1 GiB"), 1073.74, 0.01);
  EXPECT_EQ(secondsOf("90"), 90);
  EXPECT_EQ(secondsOf("1.5 h"), 5400);
  for (const char* wrong : {"", "GB", "3 lightyears", "-1 GB", "1 GB more", "inf", "nan"})
    EXPECT_THROW(megabytesOf(wrong), std::invalid_argument) << wrong;
  EXPECT_THAT(numbersOfRanges("3"), ElementsAre(3));
  EXPECT_THAT(numbersOfRanges("1-3, 7"), ElementsAre(1, 2, 3, 7));
  for (const char* wrong : {"", "x", "3-1", "1-", "-4", "1-99999999999", "1;2"})
    EXPECT_THROW(numbersOfRanges(wrong), std::invalid_argument) << wrong;
}

}  // namespace
}  // namespace roomgraph::test
