fn $name($parameters) -> $name_of_result {
    var place = ${places}_at(0u);
    var $variable = $from;
    var rest = inst;
    while (place.count > 0u) {
        // The last of its instances that begins at or before the one that is sought.
        var low = place.items;
        var high = place.items + place.count;
        while (high - low > 1u) {
            let middle = (low + high) / 2u;
            if (${places}_at(middle).first <= rest) { low = middle; } else { high = middle; }
        }
        place = ${places}_at(low);
        rest = rest - place.first;
        $body
    }
    return $variable;
}
