// The page that leads to those of several axes: nothing to draw but the machine.
'use strict';

drawMachine();
drawSchemeSwitch();
