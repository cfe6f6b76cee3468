// Before anything is painted: who comes without a link to a view sees the flight first.

if (location.hash.length < 2) document.documentElement.dataset.first = "";
