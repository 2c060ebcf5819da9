% A circle from Octave: the document, and the following error of the X axis.
%   mkoctfile --mex stiction_run_mex.c -lstiction
%   octave circle.m
[document, signals, units] = stiction_run_mex("simulate circle", "mcfv5050ln", {"friction=lugre", "feed=16 m/min"});
found = jsondecode(document);
printf("peak error of %s: %.2f um\n", found.rows(1).axis, found.rows(1).peak_error_um);
printf("largest following error of X: %.2f u%s\n", 1e6 * max(abs(signals.X_x_set - signals.X_x)), units.X_x);
