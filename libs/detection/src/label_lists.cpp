// SPDX-License-Identifier: BSD-3-Clause
// The COCO-80 and ADE20K-150 class names.
#include "label_lists.h"

#include <array>

namespace roomgraph {
namespace {

// clang-format off
// The 80 classes of the COCO detection task in their customary order (cocodataset.org).
constexpr std::array kCoco = {
    "person", "bicycle", "car", "motorcycle", "airplane", "bus", "train", "truck", "boat", "traffic light",
    "fire hydrant", "stop sign", "parking meter", "bench", "bird", "cat", "dog", "horse", "sheep", "cow",
    "elephant", "bear", "zebra", "giraffe", "backpack", "umbrella", "handbag", "tie", "suitcase", "frisbee",
    "skis", "snowboard", "sports ball", "kite", "baseball bat", "baseball glove", "skateboard", "surfboard",
    "tennis racket", "bottle", "wine glass", "cup", "fork", "knife", "spoon", "bowl", "banana", "apple",
    "sandwich", "orange", "broccoli", "carrot", "hot dog", "pizza", "donut", "cake", "chair", "couch",
    "potted plant", "bed", "dining table", "toilet", "tv", "laptop", "mouse", "remote", "keyboard",
    "cell phone", "microwave", "oven", "toaster", "sink", "refrigerator", "book", "clock", "vase",
    "scissors", "teddy bear", "hair drier", "toothbrush"};

// The 150 classes of the ADE20K scene parsing benchmark by their first names, most frequent first (B. Zhou et
// al., Scene Parsing through ADE20K Dataset, CVPR 2017; github.com/CSAILVision/sceneparsing).
constexpr std::array kAde20k = {
    "wall", "building", "sky", "floor", "tree", "ceiling", "road", "bed", "windowpane", "grass", "cabinet",
    "sidewalk", "person", "earth", "door", "table", "mountain", "plant", "curtain", "chair", "car", "water",
    "painting", "sofa", "shelf", "house", "sea", "mirror", "rug", "field", "armchair", "seat", "fence",
    "desk", "rock", "wardrobe", "lamp", "bathtub", "railing", "cushion", "base", "box", "column",
    "signboard", "chest of drawers", "counter", "sand", "sink", "skyscraper", "fireplace", "refrigerator",
    "grandstand", "path", "stairs", "runway", "case", "pool table", "pillow", "screen door", "stairway",
    "river", "bridge", "bookcase", "blind", "coffee table", "toilet", "flower", "book", "hill", "bench",
    "countertop", "stove", "palm", "kitchen island", "computer", "swivel chair", "boat", "bar",
    "arcade machine", "hovel", "bus", "towel", "light", "truck", "tower", "chandelier", "awning",
    "streetlight", "booth", "television receiver", "airplane", "dirt track", "apparel", "pole", "land",
    "bannister", "escalator", "ottoman", "bottle", "buffet", "poster", "stage", "van", "ship", "fountain",
    "conveyer belt", "canopy", "washer", "plaything", "swimming pool", "stool", "barrel", "basket",
    "waterfall", "tent", "bag", "minibike", "cradle", "oven", "ball", "food", "step", "tank", "trade name",
    "microwave", "pot", "animal", "bicycle", "lake", "dishwasher", "screen", "blanket", "sculpture", "hood",
    "sconce", "vase", "traffic light", "tray", "ashcan", "fan", "pier", "crt screen", "plate", "monitor",
    "bulletin board", "shower", "radiator", "glass", "clock", "flag"};
// clang-format on
static_assert(kCoco.size() == 80 && kAde20k.size() == 150);

std::vector<std::string> withBackground(std::size_t classes) {
  std::vector<std::string> labels{"background"};
  labels.insert(labels.end(), kAde20k.begin(), kAde20k.begin() + static_cast<std::ptrdiff_t>(classes));
  return labels;
}

}  // namespace

const char* cocoLabel(int index) {
  return index >= 0 && index < static_cast<int>(kCoco.size()) ? kCoco[index] : "";
}

const std::vector<LabelList>& labelLists() {
  // Mobile networks know the 31 most frequent classes of ADE20K.
  static const std::vector<LabelList> lists{{"COCO", {kCoco.begin(), kCoco.end()}},
                                            {"ADE20K", {kAde20k.begin(), kAde20k.end()}},
                                            {"ADE20K with background", withBackground(kAde20k.size())},
                                            {"ADE20K mobile", withBackground(31)}};
  return lists;
}

}  // namespace roomgraph
