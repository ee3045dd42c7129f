// SPDX-License-Identifier: Apache-2.0
// The splat view: Gaussians rasterised and shaded on a background thread, shown through OpenGL. Coarse while
// something moves, full as soon as it rests. Values in, signals out; it knows no project and no job.
#pragma once

#include <QElapsedTimer>
#include <QTimer>

#include "core/scene/capture.h"
#include "viewers/gl/picture_canvas.h"
#include "viewers/latest_worker.h"
#include "viewers/splat/splat_renderer.h"

class QKeyEvent;

namespace beam {

class SplatView final : public PictureCanvas {
  Q_OBJECT

 public:
  explicit SplatView(std::shared_ptr<ComputeDevice> device, QWidget* parent = nullptr);
  ~SplatView() override;

  // `caption` names what is shown ("frame 000002"); an empty scene shows the empty state.
  void setScene(const SplatScene& scene, const QString& caption);
  void setCapture(std::shared_ptr<const CaptureSet> capture, FrameIndex frame);  // null: none
  // `reading`: the light of this name is on its way; until it is there the one before stays.
  void setLight(std::shared_ptr<const PreparedLight> light, const QString& name, bool reading = false);

  const ViewState& state() const { return state_; }
  void setState(const ViewState& state);
  void setChannel(Channel channel);
  void setExposure(float stops);
  void setYaw(float yaw_rad);
  void setSky(bool shown);
  void setPhotoOpacity(float opacity);
  // Holds the limits of the depth that is seen now, over cameras and frames; without effect while none is.
  void lockDepth(bool on);
  void lookThrough(std::optional<ViewIndex> view);
  // The first direction, with the subject filling the view.
  void goHome();
  // The subject fills the view from where one looks.
  void frameSubject();
  void setPreset(ViewPreset preset);
  // Circles the surface at this point of the widget from now on; nothing where none is.
  void focusAt(QPointF position);
  // As at first: what belonged to the project that was open (direction, camera, channel, light, exposure,
  // sky, fade, badge) is gone.
  void resetState();

  // Keys of product 4.6; false: not one of ours. The window passes on keys that nobody else wanted.
  bool handleKey(const QKeyEvent& event);
  // The newest full-size picture is on the screen.
  bool settled() const;
  // The newest picture that was asked for is on the screen, whatever its size.
  bool upToDate() const { return !scene_.cloud || shown_ticket_ == newest_ticket_; }
  // Frames pass by: every scene is drawn once, at the width and height divided by this; 0: they do not.
  void setPassing(int divisor);
  // What a picture of half size takes while frames pass by: measured, before that told from the full one.
  double halfPictureMilliseconds() const {
    return half_milliseconds_ > 0 ? half_milliseconds_ : full_milliseconds_ / 4;
  }
  double fullPictureMilliseconds() const { return full_milliseconds_; }  // the last one took

 Q_SIGNALS:
  void stateChanged(const beam::ViewState& state);
  void hovered(const QString& reading);
  void pictureShown();

 protected:
  bool event(QEvent* event) override;
  PictureLayout pictureLayout() const override;
  void paintOver(QPainter& painter) override;
  void resizeGL(int width, int height) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  enum class Pace { Moving, Resting };

  void changed(Pace pace);
  void request(int divisor);
  void take(SplatPicture picture, int divisor, std::uint64_t ticket);
  void loadPhoto();
  void dropPhoto();
  void turnHome();
  void leaveCamera();
  void nextCamera(int step);
  void cycleChannel(int step);
  ivec2 pixelAt(QPointF position, int width_px, int height_px) const;
  void reportHover(QPointF position);
  Camera cameraFor(int width_px, int height_px) const;
  QRectF photoFrame() const;
  QString title() const;
  QString lackText() const;
  QString noteText() const;
  Bounds sceneBounds() const;

  std::shared_ptr<SplatRenderer> renderer_;
  SplatScene scene_;
  QString caption_, light_name_;
  QString light_being_read_;  // its name; empty: none is
  std::shared_ptr<const CaptureSet> capture_;
  FrameIndex frame_;
  std::shared_ptr<const PreparedLight> light_;
  ViewState state_;
  bool framed_ = false;              // the orbit was set to the scene once
  bool keep_photo_opacity_ = false;  // the user chose it

  SplatPicture shown_;
  int shown_divisor_ = 0;
  std::uint64_t newest_ticket_ = 0, shown_ticket_ = 0;
  double full_milliseconds_ = 200;  // of the last full picture
  double half_milliseconds_ = 0;    // lately; 0: none yet since frames pass by
  int passing_ = 0;
  std::optional<ViewIndex> photo_of_;  // of frame_
  std::uint64_t photo_ticket_ = 0;     // of the photograph asked for last
  QString photo_note_;

  QTimer rest_timer_;
  QPointF last_mouse_;
  LatestWorker photo_worker_;
  LatestWorker worker_;  // last: it stops first
};

// Middle of a cloud and the radius that holds most of it; stray Gaussians do not count.
Bounds boundsOf(const std::vector<vec3>& positions_m);

// "light dome turned 30°"
QString lightWords(const QString& name, float yaw_rad);

}  // namespace beam
