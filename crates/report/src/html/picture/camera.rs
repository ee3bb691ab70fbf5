//! Parallel projection of a drawing in space to a sheet.

/// Directions of a view: to the right, upward, and toward the viewer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Camera {
    right: [f64; 3],
    up: [f64; 3],
}

/// View as two angles in degrees: `azimuth` turns about z, `elevation` is the height of the viewer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ViewAngles {
    pub(super) azimuth: f64,
    pub(super) elevation: f64,
}

/// Camera with the scale and the middle of a sheet in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Projection {
    pub(super) camera: Camera,
    /// Pixels per unit of the grid.
    pub(super) scale: f64,
    /// Place of the grid's middle on the sheet.
    pub(super) middle: [f64; 2],
}

impl Camera {
    /// Camera of a view. With an azimuth of -90 degrees x points to the right.
    pub(super) fn of(view: ViewAngles) -> Self {
        let (azimuth, elevation) = (view.azimuth.to_radians(), view.elevation.to_radians());
        let [sa, ca, se, ce] = [libm::sin(azimuth), libm::cos(azimuth), libm::sin(elevation), libm::cos(elevation)];
        Self { right: [-sa, ca, 0.0], up: [-se * ca, -se * sa, ce] }
    }

    /// Point on the sheet, with y downward, in units of the grid.
    pub(super) fn flat(&self, point: [f64; 3]) -> [f64; 2] {
        let dot = |axis: &[f64; 3]| (0..3).map(|i| axis[i] * point[i]).sum::<f64>();
        [dot(&self.right), -dot(&self.up)]
    }
}

impl Projection {
    /// Point on the sheet in pixels.
    pub(super) fn at(&self, point: [f64; 3]) -> [f64; 2] {
        let [x, y] = self.camera.flat(point);
        [self.middle[0] + self.scale * x, self.middle[1] + self.scale * y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The isometric view: all three axes have the same length sqrt(2/3), and x and y fall by 30 degrees.
    #[test]
    fn an_isometric_view_shortens_all_axes_alike() {
        // The angle of a cube's diagonal above its face.
        let elevation = libm::atan(0.5f64.sqrt()).to_degrees();
        let camera = Camera::of(ViewAngles { azimuth: -45.0, elevation });
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| camera.flat(axis));
        for [x, y] in axes {
            assert!((libm::hypot(x, y) - (2.0f64 / 3.0).sqrt()).abs() < 1e-12);
        }
        // x comes toward the viewer, so that it falls on the sheet, and y goes away. z points upward.
        assert!((libm::atan2(axes[0][1], axes[0][0]).to_degrees() - 30.0).abs() < 1e-9);
        assert!((libm::atan2(axes[1][1], axes[1][0]).to_degrees() + 30.0).abs() < 1e-9);
        assert!(axes[2][0].abs() < 1e-12 && axes[2][1] < 0.0);
    }
}
