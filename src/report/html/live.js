"use strict";
// While records arrive: the page looks whether a newer one was written, and reloads itself at the same place. The
// script beside it states the version of the newest; it is gone when the last page is written.
(() => {
  const { state, version } = document.currentScript.dataset;
  const place = `impactid ${location.pathname}`;
  let seen = false;

  function reload() {
    try { sessionStorage.setItem(place, String(window.scrollY)); } catch { /* then at its top */ }
    location.reload();
  }

  window.impactidLive = (newest) => {
    seen = true;
    if (newest !== version) reload();
  };

  function look() {
    if (document.hidden) return;
    const script = document.createElement("script");
    script.src = `${state}?${Date.now()}`;
    script.onload = () => script.remove();
    // a page that was copied to another place never sees the state, and stays as it is
    script.onerror = () => { script.remove(); if (seen) reload(); };
    document.head.append(script);
  }

  window.addEventListener("load", () => {
    try {
      const at = sessionStorage.getItem(place);
      sessionStorage.removeItem(place);
      if (at !== null) window.scrollTo(0, Number(at));
    } catch { /* then where the browser has put it */ }
    look();
  });
  document.addEventListener("visibilitychange", look);
  setInterval(look, 3000);
})();
