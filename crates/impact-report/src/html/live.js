"use strict";
// While records arrive: the page looks whether a newer one was written, and reloads itself at the same place. The
// script beside it states the version of the newest; it is gone when the last page is written.
(() => {
  const { state, version } = document.currentScript.dataset;
  const key = `impactid ${location.pathname}`;
  let seen = false, before = {};

  // where the reader was, and for which version the page was reloaded
  try {
    before = JSON.parse(sessionStorage.getItem(key)) ?? {};
    sessionStorage.removeItem(key);
  } catch { /* then the browser decides where the page opens */ }

  function reload(newest) {
    try { sessionStorage.setItem(key, JSON.stringify({ place: window.scrollY, newest })); } catch { /* as above */ }
    location.reload();
  }

  window.impactidLive = (newest) => {
    seen = true;
    // once for each version: the page may be written a moment before its version is stated
    if (newest !== version && newest !== before.newest) reload(newest);
  };

  function look() {
    if (document.hidden) return;
    const script = document.createElement("script");
    script.src = `${state}?${Date.now()}`;
    script.onload = () => script.remove();
    // a page that was copied to another place never sees the state, and stays as it is
    script.onerror = () => { script.remove(); if (seen) reload(null); };
    document.head.append(script);
  }

  window.addEventListener("load", () => {
    if (before.place !== undefined) window.scrollTo(0, before.place);
    look();
  });
  document.addEventListener("visibilitychange", look);
  setInterval(look, 3000);
})();
