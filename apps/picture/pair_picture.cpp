// SPDX-License-Identifier: MIT
#include "apps/picture/pair_picture.h"

#include <algorithm>
#include <cmath>

#include "apps/picture/lettering.h"

namespace corral {
namespace {

// Colours that stay apart for colour-blind readers and in print.
const Color kWhite(255, 255, 255), kBlack(0, 0, 0), kGrey(110, 110, 110), kSurface(214, 214, 220);
const Color kGreen(0, 158, 115), kRed(222, 60, 20), kBlue(0, 114, 178), kFaint(95, 105, 150);
const Color kSourceColor(245, 170, 50), kTargetColor(95, 165, 235);

/// The orientation of the two surfaces.
struct Views {
  Eigen::Matrix3d view_from_source, view_from_target;
};

/// A surface of which more than half faces one side is a view, best seen from there; else the source decides. With the truth
/// both are oriented alike.
Views choose_views(const PairScene& scene) {
  const ChosenView source = choose_view(scene.source), target = choose_view(scene.target);
  if (!scene.truth) return {source.view_from_mesh, target.view_from_mesh};
  const Eigen::Matrix3d& rotation = scene.truth->rotation;
  if (target.facing > 0.5) return {target.view_from_mesh * rotation, target.view_from_mesh};
  return {source.view_from_mesh, source.view_from_mesh * rotation.transpose()};
}

struct TitlePart {
  std::string text;
  Color color;
};

/// Sizes in pixels that follow from the width of a picture.
struct Layout {
  explicit Layout(int width) : margin(width / 50.0), letters(std::max(9.0, width / 54.0)), top(3 * letters) {}
  double margin, letters, top;
};

/// Words side by side above the picture, smaller if they would not fit.
void draw_title(Image& image, const std::vector<TitlePart>& parts) {
  const Layout layout(image.width);
  double length = 0;
  for (const TitlePart& part : parts) length += text_width(part.text, layout.letters);
  const double size = layout.letters * std::min(1.0, (image.width - 2 * layout.margin) / std::max(length, 1.0));
  Place place(layout.margin, 2 * layout.letters);
  for (const TitlePart& part : parts) {
    draw_text(image, place, part.text, size, part.color);
    place.x() += text_width(part.text, size);
  }
}

/// Pixels per mesh unit, so that something of this extent fits; 1 for a single point.
double fitting_scale(double width, double height, const Eigen::Vector2d& extent) {
  const double scale = std::min(width / extent.x(), height / extent.y());
  return std::isfinite(scale) ? scale : 1;
}

/// The two surfaces before any match is drawn.
struct Base {
  Image image;
  Projection source, target;
};

/// Side by side at one scale; the picture gets the height of the taller one.
Base draw_base(const PairScene& scene, int width) {
  const Views views = choose_views(scene);
  const Eigen::AlignedBox3d source = view_box(scene.source.mesh.vertices, views.view_from_source);
  const Eigen::AlignedBox3d target = view_box(scene.target.mesh.vertices, views.view_from_target);
  const Layout layout(width);
  const double wide = 1.1 * (source.sizes().x() + target.sizes().x());  // with the gap between them
  const double high = std::max(source.sizes().y(), target.sizes().y());
  const double scale = fitting_scale(width - 2 * layout.margin, 0.6 * width, {wide, high});
  const double left = (width - scale * wide) / 2, middle = layout.top + scale * high / 2;
  const double source_middle = left + scale * source.sizes().x() / 2;
  const double target_middle = left + scale * (wide - target.sizes().x() / 2);
  Base base{Image(0, 0, kWhite),
            {views.view_from_source, source.center(), scale, {source_middle, middle}},
            {views.view_from_target, target.center(), scale, {target_middle, middle}}};
  Raster raster(width, static_cast<int>(std::ceil(layout.top + scale * high + layout.margin)), kWhite);
  paint(raster, scene.source, base.source, kSurface);
  paint(raster, scene.target, base.target, kSurface);
  base.image = raster.image();
  return base;
}

/// Lines between the two ends of some matches, with a dot at each.
void draw_matches(Image& image, const PairScene& scene, const Base& base, const Indices& rows, const Pen& pen) {
  for (const int row : rows) {
    const Place from = base.source(scene.source_points.row(row).transpose()).head<2>();
    const Place to = base.target(scene.target_points.row(row).transpose()).head<2>();
    draw_line(image, from, to, pen);
    for (const Place& end : {from, to}) draw_line(image, end, end, {pen.color, 3.6 * pen.width, (1 + pen.opacity) / 2});
  }
}

Image match_picture(const PairScene& scene, const Base& base, const DrawnGroup& group) {
  Indices correct, incorrect, missed;
  for (int row = 0; row < scene.source_points.rows(); ++row) {
    const bool is_correct = scene.correct.empty() || scene.correct[static_cast<std::size_t>(row)];
    if (std::binary_search(group.selected.begin(), group.selected.end(), row))
      (is_correct ? correct : incorrect).push_back(row);
    else if (is_correct)
      missed.push_back(row);
  }
  Image image = base.image;
  const auto draw = [&](const Indices& rows, const Color& color, double most) {
    // The more lines there are of a kind, the more transparent they are.
    const double opacity = std::clamp(8 / std::sqrt(1.0 + static_cast<double>(rows.size())), 0.22, most);
    draw_matches(image, scene, base, rows, {color, image.width / 1000.0, opacity});
  };
  draw(missed, kFaint, scene.correct.empty() ? 0.25 : 0.5);
  if (incorrect.size() > correct.size()) draw(incorrect, kRed, 0.9);  // the fewer on top
  draw(correct, scene.correct.empty() ? kBlue : kGreen, 0.9);
  if (incorrect.size() <= correct.size()) draw(incorrect, kRed, 0.9);
  const auto count = [](const Indices& rows, const std::string& word) {
    return std::to_string(rows.size()) + " " + word;
  };
  if (scene.correct.empty())
    draw_title(image, {{group.title + "    ", kBlack},
                       {count(correct, "selected"), kBlue},
                       {", ", kBlack},
                       {count(missed, "not"), kFaint}});
  else
    draw_title(image, {{group.title + "    ", kBlack},
                       {count(correct, "correct"), kGreen},
                       {",  ", kBlack},
                       {count(incorrect, "incorrect"), kRed},
                       {",  ", kBlack},
                       {count(missed, "missed"), kFaint}});
  return image;
}

}  // namespace

std::vector<Image> match_pictures(const PairScene& scene, const std::vector<DrawnGroup>& groups, int width) {
  const Base base = draw_base(scene, width);
  std::vector<Image> pictures;
  for (const DrawnGroup& group : groups) pictures.push_back(match_picture(scene, base, group));
  return pictures;
}

std::vector<Image> alignment_pictures(const PairScene& scene, const std::vector<DrawnPose>& poses, int width) {
  const Eigen::Matrix3d view = choose_views(scene).view_from_target;
  // A pose with a large error may move the source out of the picture, but not shrink everything.
  Eigen::AlignedBox3d box = view_box(scene.target.mesh.vertices, view), most = box;
  most.min() -= 0.3 * box.sizes();
  most.max() += 0.3 * box.sizes();
  for (const DrawnPose& pose : poses)
    if (pose.target_from_source)
      box.extend(view_box(pose.target_from_source->apply(scene.source.mesh.vertices), view).intersection(most));
  const Layout layout(width);
  const double scale = fitting_scale(width - 2 * layout.margin, 1.2 * width, box.sizes().head<2>());
  const int height = static_cast<int>(std::ceil(layout.top + scale * box.sizes().y() + layout.margin));
  const Projection projection{view, box.center(), scale, {width / 2.0, layout.top + scale * box.sizes().y() / 2}};
  std::vector<Image> pictures;
  for (const DrawnPose& pose : poses) {
    Raster raster(width, height, kWhite);
    paint(raster, scene.target, projection, kTargetColor);
    if (pose.target_from_source) paint(raster, moved(scene.source, *pose.target_from_source), projection, kSourceColor);
    pictures.push_back(raster.image());
    draw_title(pictures.back(), {{pose.title, kBlack}});
  }
  return pictures;
}

Image contact_sheet(const std::vector<Image>& pictures, int columns) {
  const int count = static_cast<int>(pictures.size()), rows = (count + columns - 1) / columns;
  if (count == 0) return {0, 0, kWhite};
  Image sheet(columns * pictures[0].width, rows * pictures[0].height, kWhite);
  for (int i = 0; i < count; ++i) {
    const Image& picture = pictures[static_cast<std::size_t>(i)];
    paste(sheet, picture, i % columns * picture.width, i / columns * picture.height);
  }
  return sheet;
}

}  // namespace corral
