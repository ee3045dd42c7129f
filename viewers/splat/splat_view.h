// SPDX-License-Identifier: Apache-2.0
// The splat view: a scene through a scene renderer, on a background thread where that draws on the host,
// shown through OpenGL. Coarse while something moves, full as soon as it rests. Values in, signals out; it
// knows no project and no job.
#pragma once

#include <QTimer>

#include <atomic>
#include <map>

#include "core/scene/capture.h"
#include "viewers/gl/picture_canvas.h"
#include "viewers/latest_worker.h"
#include "viewers/splat/splat_renderer.h"

class QKeyEvent;

namespace beam {

class ChannelPainter;

class SplatView final : public PictureCanvas {
  Q_OBJECT

 public:
  // Makes its renderer at once, and another where its OpenGL context is another.
  explicit SplatView(SceneRendererFactory new_renderer, QWidget* parent = nullptr);
  ~SplatView() override;

  const RendererAbilities& abilities() const { return renderer_->abilities(); }
  // `caption` names what is shown ("frame 000002"); without Gaussians it shows the empty state.
  void setScene(std::vector<RenderInstance> instances, const QString& caption);
  void setCapture(std::shared_ptr<const CaptureSet> capture, FrameIndex frame);  // null: none
  // `reading`: the light of this name is on its way; until it is there the one before stays.
  void setLight(std::shared_ptr<const Environment> light, const QString& name, bool reading = false);
  // How it falls; its turn is the view's own (setYaw).
  void setLighting(const Lighting& lighting);

  const ViewState& state() const { return state_; }
  void setState(const ViewState& state);
  void setChannel(const ChannelInfo& channel);
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

  // The view's own keys; false: not one of them. The window passes on keys that nobody else wanted.
  bool handleKey(const QKeyEvent& event);
  // The newest full-size picture is on the screen, as good as it gets.
  bool settled() const;
  // What stands over the picture: its channel, camera and caption, though a newer one is asked for already.
  QString title() const;
  // The newest picture that was asked for is on the screen, whatever its size.
  bool upToDate() const { return !hasScene() || shown_ticket_ == newest_ticket_; }
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
  void initializeGL() override;
  bool paintUnder(const QRectF& target_px, const QSizeF& framebuffer) override;
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
  // A picture that was asked for.
  struct Wish {
    SplatRequest request;
    int divisor = 1;
    std::uint64_t ticket = 0;
    QString caption;
  };

  struct Drawing;

  bool hasScene() const { return !scene_.instances.empty(); }
  bool hasShown() const { return hasPicture(0) || shownTexture() != 0; }
  std::uint32_t shownTexture() const;  // 0: what is shown is no texture
  void newContext();
  void leaveContext();
  void changed(Pace pace);
  void request(int divisor);
  // On the worker's thread, or with the context current. Any error is a picture that says so.
  void answer(const Wish& wish, SplatRenderer& renderer, Drawing& drawing,
              const SplatRenderer::OnPicture& on_picture);
  void take(SplatPicture picture, const Wish& wish);
  void loadPhoto();
  void dropPhoto();
  void turnHome();
  void leaveCamera();
  void nextCamera(int step);
  void cycleChannel(int step);
  ivec2 pixelAt(QPointF position, int width_px, int height_px) const;
  // A shown channel on the host, read back where it is a texture; empty: it is not in the picture.
  const Planes& hostValues(std::string_view channel);
  void reportHover(QPointF position);
  Camera cameraFor(int width_px, int height_px) const;
  QRectF photoFrame() const;
  QString lackText() const;
  QString noteText() const;
  Bounds sceneBounds() const;

  SceneRendererFactory new_renderer_;
  std::shared_ptr<SplatRenderer> renderer_;
  RenderScene scene_;                             // the light is in it as the state says
  QString caption_, shown_caption_, light_name_;  // caption_: of what is asked for
  std::optional<QPointF> pointer_;                // over the view
  QString light_being_read_;                      // its name; empty: none is
  std::shared_ptr<const CaptureSet> capture_;
  FrameIndex frame_;
  ViewState state_;
  bool framed_ = false;              // the orbit was set to the scene once
  bool keep_photo_opacity_ = false;  // the user chose it

  SplatPicture shown_;
  int shown_divisor_ = 0;
  std::atomic<std::uint64_t> newest_ticket_ = 0;
  std::uint64_t shown_ticket_ = 0;
  std::optional<Wish> waiting_;                           // for the context
  std::shared_ptr<Drawing> drawing_;                      // of the newest wish
  std::map<std::string, Planes, std::less<>> read_back_;  // channels of shown_ that are textures
  double full_milliseconds_ = 200;                        // of the last full picture
  double half_milliseconds_ = 0;                          // lately; 0: none yet since frames pass by
  int passing_ = 0;
  std::optional<ViewIndex> photo_of_;  // of frame_
  std::uint64_t photo_ticket_ = 0;     // of the photograph asked for last
  QString photo_note_;
  std::unique_ptr<ChannelPainter> channel_painter_;  // of textures

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
