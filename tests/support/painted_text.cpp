// SPDX-License-Identifier: Apache-2.0
#include "tests/support/painted_text.h"

#include <QPaintDevice>
#include <QPaintEngine>
#include <QPainter>
#include <QPainterPath>

#include <algorithm>

namespace beam::testing {
namespace {

// Keeps words and forgets the rest.
class Listener final : public QPaintEngine {
 public:
  explicit Listener(std::vector<PaintedText>& heard) : QPaintEngine(AllFeatures), heard_(heard) {}
  bool begin(QPaintDevice*) override { return true; }
  bool end() override { return true; }
  Type type() const override { return User; }
  void updateState(const QPaintEngineState&) override {}
  void drawPixmap(const QRectF&, const QPixmap&, const QRectF&) override {}
  void drawPolygon(const QPointF*, int, PolygonDrawMode) override {}
  void drawPath(const QPainterPath&) override {}
  void drawImage(const QRectF&, const QImage&, const QRectF&, Qt::ImageConversionFlags) override {}
  void drawTextItem(const QPointF& at, const QTextItem& item) override {
    const QRectF box(at.x(), at.y() - item.ascent(), item.width(), item.ascent() + item.descent());
    const QPainter& p = *painter();
    const QTransform& t = p.deviceTransform();
    QRectF clip(0, 0, paintDevice()->width(), paintDevice()->height());
    if (p.hasClipping()) clip &= t.mapRect(p.clipBoundingRect());
    if (!item.text().trimmed().isEmpty()) heard_.push_back({item.text(), t.mapRect(box), clip});
  }

 private:
  std::vector<PaintedText>& heard_;
};

class ListeningDevice final : public QPaintDevice {
 public:
  ListeningDevice(const QWidget& like, std::vector<PaintedText>& heard) : like_(like), engine_(heard) {}
  QPaintEngine* paintEngine() const override { return &engine_; }

 protected:
  int metric(PaintDeviceMetric what) const override {
    switch (what) {
      case PdmWidth:
        return like_.width();
      case PdmHeight:
        return like_.height();
      case PdmDpiX:
      case PdmPhysicalDpiX:
        return like_.logicalDpiX();
      case PdmDpiY:
      case PdmPhysicalDpiY:
        return like_.logicalDpiY();
      case PdmDepth:
        return 32;
      case PdmNumColors:
        return 1 << 24;
      case PdmDevicePixelRatio:
        return 1;
      case PdmDevicePixelRatioScaled:
        return static_cast<int>(devicePixelRatioFScale());
      default:
        return 0;
    }
  }

 private:
  const QWidget& like_;
  mutable Listener engine_;
};

}  // namespace

double PaintedText::cutWide() const {
  return std::max(0.0, clip.left() - place.left()) + std::max(0.0, place.right() - clip.right());
}

double PaintedText::cutHigh() const {
  return std::max(0.0, clip.top() - place.top()) + std::max(0.0, place.bottom() - clip.bottom());
}

std::vector<PaintedText> paintedTexts(QWidget& widget) {
  std::vector<PaintedText> heard;
  if (widget.inherits("QOpenGLWidget") || widget.inherits("QVTKOpenGLNativeWidget")) return heard;
  ListeningDevice device(widget, heard);
  widget.render(&device, {}, {}, QWidget::RenderFlags());
  return heard;
}

}  // namespace beam::testing
