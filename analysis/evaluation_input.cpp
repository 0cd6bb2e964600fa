#include "analysis/evaluation_input.h"

#include <chrono>
#include <map>
#include <set>

#include "core/atomic_file.h"
#include "core/hash.h"
#include "core/image_file.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string NameOf(const std::string& file) {
  return fs::path(file).filename().string();
}

std::set<std::string> PictureNames(const DatasetIndex& index) {
  std::set<std::string> names;
  for (const DatasetScene& scene : index.scenes) {
    for (const DatasetPicture& picture : scene.pictures) names.insert(NameOf(picture.file));
  }
  return names;
}

}  // namespace

void CheckPictures(const Evaluation& evaluation, const fs::path& dataset) {
  ParallelFor(static_cast<int64_t>(evaluation.pictures.size()), [&](int64_t index) {
    const DatasetPicture& picture = *evaluation.pictures[static_cast<size_t>(index)].picture;
    const fs::path file = dataset / picture.file;
    if (HexHash(HashBytes(ReadTextFile(file))) == picture.hash) return;
    throw InputError::At(file, "", "another picture than the one that was labelled",
                         fmt::format("bytes of hash {}", picture.hash));
  });
}

std::vector<std::vector<Detection>> IdentifyPictures(const Evaluation& evaluation,
                                                     const fs::path& dataset, const Method& method,
                                                     const MarkerSet& markers, Progress& progress,
                                                     IdentificationTimes& times) {
  std::vector<std::vector<Detection>> detections(evaluation.pictures.size());
  const Clock::time_point start = Clock::now();
  ParallelFor(static_cast<int64_t>(detections.size()), [&](int64_t index) {
    const auto i = static_cast<size_t>(index);
    const DatasetPicture& picture = *evaluation.pictures[i].picture;
    DigitalImage image = ReadGrey(dataset / picture.file);
    image.bits = picture.bits;
    const Clock::time_point begin = Clock::now();
    detections[i] = method(image, markers, nullptr);
    times.identify_s += SecondsSince(begin);
    progress.Advance(1);
  });
  times.wall_s = SecondsSince(start);
  return detections;
}

std::vector<std::vector<Detection>> DetectionsOfPictures(const Evaluation& evaluation,
                                                         const DatasetIndex& index,
                                                         const fs::path& file,
                                                         const DetectionsFile& detections) {
  const std::set<std::string> names = PictureNames(index);
  std::map<std::string, const PictureDetections*> given;
  for (size_t i = 0; i < detections.pictures.size(); ++i) {
    const PictureDetections& picture = detections.pictures[i];
    const std::string name = NameOf(picture.file);
    const std::string place = fmt::format("/images/{}/file", i);
    if (!names.contains(name)) {
      throw InputError::At(
          file, place, fmt::format("'{}'", picture.file),
          "a picture of the dataset, such as " + evaluation.pictures.front().picture->file);
    }
    if (!given.emplace(name, &picture).second) {
      throw InputError::At(file, place, fmt::format("'{}' a second time", name),
                           "one entry for each picture");
    }
  }
  std::vector<std::vector<Detection>> ordered;
  size_t missing = 0;
  std::string first_missing;
  for (const EvaluatedPicture& evaluated : evaluation.pictures) {
    const auto found = given.find(NameOf(evaluated.picture->file));
    if (found != given.end()) {
      ordered.push_back(found->second->detections);
    } else if (missing++ == 0) {
      first_missing = evaluated.picture->file;
    }
  }
  if (missing > 0) {
    throw InputError::At(
        file, "/images",
        fmt::format("{} of the {} pictures are missing, the first {}", missing,
                    evaluation.pictures.size(), first_missing),
        "an entry for each picture of the split, with \"detections\": [] where nothing was found");
  }
  return ordered;
}

}  // namespace retrolux
