// Dark or light: as the system has it, or as the reader chose, which is kept for all pages that the browser keeps
// together. Runs before anything is drawn.
'use strict';

const SCHEME_KEY = 'stiction-scheme';
const prefersDark = matchMedia('(prefers-color-scheme: dark)');

// "light", "dark", or "auto" where nothing was chosen or the browser keeps nothing for files.
function chosenScheme() {
  try {
    const kept = localStorage.getItem(SCHEME_KEY);
    return kept === 'dark' || kept === 'light' ? kept : 'auto';
  } catch {
    return 'auto';
  }
}

function keepScheme(choice) {
  try {
    choice === 'auto' ? localStorage.removeItem(SCHEME_KEY) : localStorage.setItem(SCHEME_KEY, choice);
  } catch { /* this page alone follows the switch */ }
}

// Paper is light, whatever was chosen.
function applyScheme(choice) {
  const root = document.documentElement;
  root.dataset.scheme = root.classList.contains('paper') ? 'light' : choice === 'auto' ? (prefersDark.matches ? 'dark' : 'light') : choice;
}

applyScheme(chosenScheme());
