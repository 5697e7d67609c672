// Returns a text of what was thrown, which may be anything and is never shown as nothing.
export function detail(thrown) {
  const unsaid = "it failed without a message";
  try {
    const message = thrown?.message ?? thrown;
    if (typeof message === "string" && message.trim() !== "") {
      return message;
    }
    return `${unsaid}: ${String(thrown)}`;
  } catch {
    return unsaid;
  }
}
