// The files that assets.S embeds in the program, by the labels it puts around them.
#include "host/report/assets.hpp"

#define STICTION_ASSET(name)                                                                                       \
  extern "C" const char stiction_asset_##name[];                                                                   \
  extern "C" const char stiction_asset_##name##_end[];                                                             \
  namespace stiction::host::assets {                                                                               \
  std::string_view name() {                                                                                        \
    return {stiction_asset_##name, static_cast<std::size_t>(stiction_asset_##name##_end - stiction_asset_##name)}; \
  }                                                                                                                \
  }

STICTION_ASSET(frame_html)
STICTION_ASSET(opening_html)
STICTION_ASSET(closing_html)
STICTION_ASSET(axes_html)
STICTION_ASSET(axes_js)
STICTION_ASSET(circle_html)
STICTION_ASSET(experiment_html)
STICTION_ASSET(identification_html)
STICTION_ASSET(colours_css)
STICTION_ASSET(report_css)
STICTION_ASSET(scheme_js)
STICTION_ASSET(page_js)
STICTION_ASSET(models_js)
STICTION_ASSET(figures_js)
STICTION_ASSET(cursors_js)
STICTION_ASSET(save_js)
STICTION_ASSET(machine_js)
STICTION_ASSET(circle_plots_js)
STICTION_ASSET(circle_series_js)
STICTION_ASSET(circle_tables_js)
STICTION_ASSET(circle_js)
STICTION_ASSET(charts_js)
STICTION_ASSET(diagnosis_js)
STICTION_ASSET(diagnosis_html)
STICTION_ASSET(experiment_js)
STICTION_ASSET(identification_js)
STICTION_ASSET(step_cam_html)
STICTION_ASSET(step_cam_js)
STICTION_ASSET(fleet_html)
STICTION_ASSET(fleet_js)
STICTION_ASSET(plotly_js)
STICTION_ASSET(plotly_license)
