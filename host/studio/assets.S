// The studio's page and its programme, embedded. Assembled with the repository's root and the folder of studio.wasm
// among the include directories.

.macro asset name, file
  .global stiction_studio_\name
  .global stiction_studio_\name\()_end
stiction_studio_\name:
  .incbin "\file"
stiction_studio_\name\()_end:
.endm

  .section .rodata, "a", %progbits
asset html, "host/studio/web/studio.html"
asset css, "host/studio/web/studio.css"
asset engine_js, "host/studio/web/engine.js"
asset charts_js, "host/studio/web/charts.js"
asset studio_js, "host/studio/web/studio.js"
asset step_js, "host/studio/web/step.js"
asset report_js, "host/studio/web/report.js"
asset wasm, "studio.wasm"

  .section .note.GNU-stack, "", %progbits
