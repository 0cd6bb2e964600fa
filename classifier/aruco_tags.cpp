// The dictionary DICT_4X4_50 with OpenCV's aruco (Garrido-Jurado and others 2014).
#include <opencv2/aruco.hpp>

#include "classifier/tag_libraries.h"

namespace retrolux {

namespace {

cv::Ptr<cv::aruco::Dictionary> TheDictionary() {
  return cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
}

template <cv::aruco::CornerRefineMethod kRefinement>
std::vector<FoundTag> Find(const DigitalImage& image) {
  Plane<uint8_t> grey = EightBits(image);
  const cv::Mat view(grey.height, grey.width, CV_8UC1, grey.data.data());
  const cv::Ptr<cv::aruco::DetectorParameters> parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = kRefinement;
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(view, TheDictionary(), corners, ids, parameters);
  std::vector<FoundTag> tags;
  for (size_t i = 0; i < ids.size(); ++i) {
    FoundTag tag{ids[i], {}};
    for (size_t k = 0; k < 4; ++k) {
      // Clockwise from the upper left one; ours go the other way from the lower left one.
      const cv::Point2f& p = corners[i][3 - k];
      tag.corners_px[k] = Vec2d(p.x, p.y);
      // What OpenCV took over from AprilTag it left in that library's coordinates (measured:
      // docs/witness.md).
      if (kRefinement == cv::aruco::CORNER_REFINE_APRILTAG) tag.corners_px[k] += kCentreFromCorner;
    }
    tags.push_back(tag);
  }
  return tags;
}

Plane<uint8_t> Pattern(int id) {
  constexpr int kSide = 6;  // 4 x 4 bits in a dark border
  cv::Mat image;
  TheDictionary()->drawMarker(id, kSide, image);
  Plane<uint8_t> cells(kSide + 2, kSide + 2, 1);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) cells(x + 1, y + 1) = image.at<uint8_t>(y, x) != 0;
  }
  return cells;
}

}  // namespace

TagFamily Aruco4x4() {
  using namespace cv::aruco;
  return {"aruco4x4",
          50,
          8,
          Pattern,
          {{"AprilTag 2", Find<CORNER_REFINE_APRILTAG>},
           {"as the library: not refined", Find<CORNER_REFINE_NONE>},
           {"lines through the contour", Find<CORNER_REFINE_CONTOUR>},
           {"cornerSubPix", Find<CORNER_REFINE_SUBPIX>}}};
}

}  // namespace retrolux
