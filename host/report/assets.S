// The report's page, style and scripts as they lie in host/report/web, embedded in the program. Assembled with the
// repository's root among the include directories.

#if defined(__APPLE__)
#error "only ELF targets are supported"
#endif

.macro asset name, file
  .global stiction_asset_\name
  .hidden stiction_asset_\name
  .global stiction_asset_\name\()_end
  .hidden stiction_asset_\name\()_end
stiction_asset_\name:
  .incbin "\file"
stiction_asset_\name\()_end:
.endm

  .section .rodata, "a", %progbits
asset frame_html, "host/report/web/frame.html"
asset opening_html, "host/report/web/opening.html"
asset closing_html, "host/report/web/closing.html"
asset axes_html, "host/report/web/axes.html"
asset axes_js, "host/report/web/axes.js"
asset circle_html, "host/report/web/circle.html"
asset experiment_html, "host/report/web/experiment.html"
asset identification_html, "host/report/web/identification.html"
asset colours_css, "host/report/web/colours.css"
asset report_css, "host/report/web/report.css"
asset page_js, "host/report/web/page.js"
asset scheme_js, "host/report/web/scheme.js"
asset figures_js, "host/report/web/figures.js"
asset cursors_js, "host/report/web/cursors.js"
asset save_js, "host/report/web/save.js"
asset models_js, "host/report/web/models.js"
asset machine_js, "host/report/web/machine.js"
asset circle_plots_js, "host/report/web/circle_plots.js"
asset circle_series_js, "host/report/web/circle_series.js"
asset circle_tables_js, "host/report/web/circle_tables.js"
asset circle_js, "host/report/web/circle.js"
asset charts_js, "host/report/web/charts.js"
asset diagnosis_js, "host/report/web/diagnosis.js"
asset diagnosis_html, "host/report/web/diagnosis.html"
asset experiment_js, "host/report/web/experiment.js"
asset step_cam_html, "host/report/web/step_cam.html"
asset step_cam_js, "host/report/web/step_cam.js"
asset fleet_html, "host/report/web/fleet.html"
asset fleet_js, "host/report/web/fleet.js"
asset identification_js, "host/report/web/identification.js"
asset plotly_js, "host/report/web/node_modules/plotly.js-basic-dist-min/plotly-basic.min.js"
asset plotly_license, "host/report/web/node_modules/plotly.js-basic-dist-min/LICENSE"

  .section .note.GNU-stack, "", %progbits
